# CI makes a few of the random trials; all of them take three hours of one core.
set(trials Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/identify/trials.py $<TARGET_FILE:edmill_cli>)
add_test(NAME identify_test COMMAND ${trials} ${CMAKE_BINARY_DIR}/identify --pairs 2 --clean 2 --every 28 --jobs 1)
set_tests_properties(identify_test PROPERTIES TIMEOUT 600)
add_test(NAME identify_long COMMAND ${trials} ${CMAKE_BINARY_DIR}/identify-long --trials 100 --pairs 100 --clean 50)
set_tests_properties(identify_long PROPERTIES TIMEOUT 36000 LABELS long)
add_test(NAME identify_cases_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/identify/cases.py $<TARGET_FILE:edmill_cli>)
set_tests_properties(identify_cases_test PROPERTIES TIMEOUT 300)
edmill_test(time_stepping_test identify/time_stepping_test.cpp)
