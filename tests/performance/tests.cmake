# The reference implementations, the comparison of figures and the recorded count of instructions;
# times are not tested.
set(benchmarks ${CMAKE_SOURCE_DIR}/verification/performance)
edmill_test(reference_loops_test performance/reference_loops_test.cpp)
target_sources(performance_tests PRIVATE ${benchmarks}/minimal_loop.cpp ${benchmarks}/peer_loop.cpp
                                       ${benchmarks}/periodic_gas.cpp)
target_include_directories(performance_tests PRIVATE ${benchmarks})

find_program(PYTHON3 python3)
if(PYTHON3)
  add_test(NAME bench_compare_test
           COMMAND ${PYTHON3} ${CMAKE_CURRENT_SOURCE_DIR}/performance/bench_compare_test.py ${benchmarks}/bench.py)
endif()
add_test(NAME instructions_test
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/performance/instructions_test.sh $<TARGET_FILE:edmill_cli>)
set_tests_properties(instructions_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
