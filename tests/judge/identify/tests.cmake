# CI makes a few of the random trials; all of them take three hours of one core.
edmill_script(identify_test identify/trials.py ${CMAKE_BINARY_DIR}/identify --pairs 2 --clean 2 --every 28 --jobs 1 TIMEOUT 600)
edmill_script(identify_long identify/trials.py ${CMAKE_BINARY_DIR}/identify-long --trials 100 --pairs 100 --clean 50 LONG 36000)
edmill_script(identify_cases_test identify/cases.py 4 TIMEOUT 600)
edmill_script(identify_cases_long identify/cases.py LONG 3600)
edmill_test(time_stepping_test identify/time_stepping_test.cpp)
