edmill_test(bad_input_test app/bad_input_test.cpp)
add_dependencies(bad_input_test edmill_cli)
