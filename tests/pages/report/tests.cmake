foreach(name series_test ward_test mill_drawing_test report_page_test report_animation_test embedded_test)
  edmill_test(${name} report/${name}.cpp LIBRARIES pugixml::pugixml nlohmann_json::nlohmann_json)
endforeach()
# The page in Debian's chromium: chromium-driver, python3-selenium.
add_test(NAME report_browser_test COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/pages/report/report_browser_test.py
                                          $<TARGET_FILE:edmill_cli> ${CMAKE_BINARY_DIR}/report-in-browser)
add_test(NAME report_browser_long COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/pages/report/report_browser_test.py
                                          $<TARGET_FILE:edmill_cli> ${CMAKE_BINARY_DIR}/report-of-mills --long)
# axe-core is not in Debian: cmake -DEDMILL_AXE=/path/to/axe.min.js
set(EDMILL_AXE ${CMAKE_BINARY_DIR}/axe.min.js CACHE FILEPATH "axe-core, which judges the accessibility of pages")
add_test(NAME accessibility_long COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/pages/report/accessibility_test.py
                                         $<TARGET_FILE:edmill_cli> ${EDMILL_AXE} ${CMAKE_BINARY_DIR}/accessibility)
set_tests_properties(accessibility_long PROPERTIES LABELS long TIMEOUT 600 SKIP_RETURN_CODE 77)
set_tests_properties(report_browser_long PROPERTIES LABELS long TIMEOUT 1800 SKIP_RETURN_CODE 77 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
set_tests_properties(report_browser_test PROPERTIES TIMEOUT 300 SKIP_RETURN_CODE 77 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
target_compile_definitions(report_tests PRIVATE EDMILL_THREE_JS="${THREE_JS}" EDMILL_THREE_ORBIT_JS="${THREE_ORBIT_JS}")
