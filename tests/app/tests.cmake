edmill_test(bad_input_test app/bad_input_test.cpp)
add_dependencies(bad_input_test edmill_cli)
add_test(NAME sweep_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/app/sweep_test.sh $<TARGET_FILE:edmill_cli>)
set_tests_properties(sweep_test PROPERTIES TIMEOUT 300)
