edmill_test(agreement_test run/agreement_test.cpp)
edmill_test(certify_test run/certify_test.cpp TIMEOUT 300 LABELS verification)
edmill_test(own_law_test run/own_law_test.cpp)
