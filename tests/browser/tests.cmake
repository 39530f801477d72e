# The mill in a browser, built by Emscripten.
add_test(NAME browser_mill_long COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/browser/page_test.py $<TARGET_FILE:edmill_cli>
                                        ${CMAKE_BINARY_DIR}/browser-mill)
set_tests_properties(browser_mill_long PROPERTIES LABELS long TIMEOUT 3600 SKIP_RETURN_CODE 77 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
