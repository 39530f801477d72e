foreach(name log_reader_test batches_test comparison_test)
  edmill_test(${name} compare/${name}.cpp TIMEOUT 300)
endforeach()
add_test(NAME suite_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/judge/compare/suite_test.sh $<TARGET_FILE:edmill_cli> ${DEBIAN_PYTHON3} ${CMAKE_BINARY_DIR}/suite)
