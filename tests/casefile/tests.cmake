find_library(UDUNITS_LIBRARY udunits2 REQUIRED)
edmill_test(quantity_test casefile/quantity_test.cpp LIBRARIES ${UDUNITS_LIBRARY})
edmill_test(case_spec_test casefile/case_spec_test.cpp)
edmill_test(build_case_test casefile/build_case_test.cpp)
