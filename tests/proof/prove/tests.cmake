edmill_test(prove_test prove/prove_test.cpp)
edmill_test(integer_balls_test prove/integer_balls_test.cpp LIBRARIES Arb::Arb)
set(certificates prove/certificates_test.py $<TARGET_FILE:check_certificate> ${CMAKE_SOURCE_DIR}/regression/reference)
edmill_script(certificates_test ${certificates} ${CMAKE_BINARY_DIR}/certificates TIMEOUT 900)
edmill_script(certificates_long ${certificates} ${CMAKE_BINARY_DIR}/certificates-long --all LONG 900)
edmill_script(certificates_without_arb_long prove/certificates_test.py $<TARGET_FILE:check_certificate_without_arb>
              ${CMAKE_SOURCE_DIR}/regression/reference ${CMAKE_BINARY_DIR}/certificates-without-arb --without-arb LONG 900)
