edmill_test(variables_test outputs/variables_test.cpp)
edmill_test(output_timer_test outputs/output_timer_test.cpp)
edmill_test(outputs_test outputs/outputs_test.cpp LIBRARIES pugixml::pugixml hdf5::hdf5)
add_dependencies(outputs_test edmill_cli)
