# The second solver of the wall tests uses Arb.
add_library(edmill_arb_oracle STATIC support/arb_oracle.cpp)
target_include_directories(edmill_arb_oracle PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_link_libraries(edmill_arb_oracle PRIVATE Arb::Arb)
target_compile_options(edmill_arb_oracle PRIVATE ${edmill_warnings} $<$<BOOL:${EDMILL_WERROR}>:-Werror>)

edmill_test(wall_search_test dynamics/wall_search_test.cpp)
edmill_test(wall_oracle_test dynamics/wall_oracle_test.cpp TIMEOUT 1200 SLOW LIBRARIES edmill_arb_oracle)
# About 3000 states of each kind in double, 30 000 in all; 100 000 in the long test.
set_property(TEST wall_oracle_test APPEND PROPERTY ENVIRONMENT EDMILL_WALL_STATES=30000)
add_test(NAME wall_oracle_long COMMAND dynamics_tests dynamics/wall_oracle_test.cpp)
set_tests_properties(wall_oracle_long PROPERTIES LABELS long TIMEOUT 3600)
edmill_test(any_mill_test dynamics/any_mill_test.cpp TIMEOUT 1200 LONG SLOW LIBRARIES edmill_arb_oracle)
edmill_test(body_search_test dynamics/body_search_test.cpp TIMEOUT 1200 LONG SLOW)
edmill_test(pair_search_test dynamics/pair_search_test.cpp)
edmill_test(impulse_test dynamics/impulse_test.cpp)
edmill_test(impulse_cases_test dynamics/impulse_cases_test.cpp)
edmill_test(gap_functions_test dynamics/gap_functions_test.cpp)
