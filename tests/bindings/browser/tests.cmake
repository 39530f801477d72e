# The mill in a browser, built by Emscripten; its steps in Node alone.
find_program(NODE NAMES node nodejs)
if(NODE)
  add_test(NAME browser_steps_test COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/bindings/browser/steps_test.js ${CMAKE_SOURCE_DIR})
endif()
add_test(NAME browser_mill_long COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/bindings/browser/page_test.py $<TARGET_FILE:edmill_cli>
                                        ${CMAKE_BINARY_DIR}/browser-mill)
set_tests_properties(browser_mill_long PROPERTIES LABELS long TIMEOUT 3600 SKIP_RETURN_CODE 77 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
