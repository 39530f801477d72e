edmill_test(prove_test prove/prove_test.cpp)
edmill_test(integer_balls_test prove/integer_balls_test.cpp LIBRARIES Arb::Arb)
foreach(name certificates_test certificates_long)
  add_test(NAME ${name} COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/proof/prove/certificates_test.py $<TARGET_FILE:edmill_cli>
                                $<TARGET_FILE:check_certificate> ${CMAKE_SOURCE_DIR}/regression/reference ${CMAKE_BINARY_DIR}/${name}
                                $<$<STREQUAL:${name},certificates_long>:--all>)
  set_tests_properties(${name} PROPERTIES TIMEOUT 900)
endforeach()
set_tests_properties(certificates_long PROPERTIES LABELS long)
add_test(NAME certificates_without_arb_long COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/proof/prove/certificates_test.py $<TARGET_FILE:edmill_cli>
                                $<TARGET_FILE:check_certificate_without_arb> ${CMAKE_SOURCE_DIR}/regression/reference
                                ${CMAKE_BINARY_DIR}/certificates-without-arb --without-arb)
set_tests_properties(certificates_without_arb_long PROPERTIES LABELS long TIMEOUT 900)
