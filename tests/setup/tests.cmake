edmill_test(build_case_test setup/build_case_test.cpp)
