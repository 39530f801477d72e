# The second solver of the wall tests uses Arb.
add_library(edmill_arb_oracle STATIC support/arb_oracle.cpp)
target_include_directories(edmill_arb_oracle PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_link_libraries(edmill_arb_oracle PRIVATE Arb::Arb)
target_compile_options(edmill_arb_oracle PRIVATE ${edmill_warnings} $<$<BOOL:${EDMILL_WERROR}>:-Werror>)

edmill_test(wall_search_test dynamics/wall_search_test.cpp)
edmill_test(wall_oracle_test dynamics/wall_oracle_test.cpp TIMEOUT 1200 LIBRARIES edmill_arb_oracle)
edmill_test(any_mill_test dynamics/any_mill_test.cpp TIMEOUT 1200 LONG LIBRARIES edmill_arb_oracle)
edmill_test(pair_search_test dynamics/pair_search_test.cpp)
edmill_test(impulse_test dynamics/impulse_test.cpp)
edmill_test(impulse_cases_test dynamics/impulse_cases_test.cpp)
edmill_test(gap_functions_test dynamics/gap_functions_test.cpp)
