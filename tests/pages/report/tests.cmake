foreach(name series_test mill_drawing_test report_page_test report_animation_test embedded_test)
  edmill_test(${name} report/${name}.cpp LIBRARIES pugixml::pugixml nlohmann_json::nlohmann_json)
endforeach()
# The page in Debian's chromium: chromium-driver, python3-selenium.
edmill_script(report_browser_test report/report_browser_test.py ${CMAKE_BINARY_DIR}/report-in-browser TIMEOUT 300)
edmill_script(report_browser_long report/report_browser_test.py ${CMAKE_BINARY_DIR}/report-of-mills --long LONG 1800)
# axe-core is not in Debian: cmake -DEDMILL_AXE=/path/to/axe.min.js
set(EDMILL_AXE ${CMAKE_BINARY_DIR}/axe.min.js CACHE FILEPATH "axe-core, which judges the accessibility of pages")
edmill_script(accessibility_long report/accessibility_test.py ${EDMILL_AXE} ${CMAKE_BINARY_DIR}/accessibility LONG 600)
