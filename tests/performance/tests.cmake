# The yardstick, the comparison of figures and the pinned count of instructions; times are not tested.
set(benchmarks ${CMAKE_SOURCE_DIR}/verification/performance)
edmill_test(peer_loop_test performance/peer_loop_test.cpp)
target_sources(peer_loop_test PRIVATE ${benchmarks}/peer_loop.cpp)
target_include_directories(peer_loop_test PRIVATE ${benchmarks})
