# In one program: they compile together.
foreach(name event_log_test log_scan_test)
  edmill_test(${name} logs/${name}.cpp TIMEOUT 300)
endforeach()
foreach(name batches_test comparison_test)
  edmill_test(${name} compare/${name}.cpp TIMEOUT 300)
endforeach()
add_test(NAME suite_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/judge/compare/suite_test.sh $<TARGET_FILE:edmill_cli> ${DEBIAN_PYTHON3} ${CMAKE_BINARY_DIR}/suite)
