# The mill in a browser, built by Emscripten; its steps in Node alone.
find_program(NODE NAMES node nodejs)
if(NODE)
  add_test(NAME browser_steps_test COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/bindings/browser/steps_test.js ${CMAKE_SOURCE_DIR})
endif()
edmill_script(browser_mill_long browser/page_test.py ${CMAKE_BINARY_DIR}/browser-mill LONG 3600)
edmill_script(browser_assemble_test browser/assemble_test.py LABELS fast)
# The npm package, by the same build.
edmill_script(npm_package_long node/package_test.py ${CMAKE_BINARY_DIR}/browser-mill LONG 3600)
set_tests_properties(browser_mill_long npm_package_long PROPERTIES RESOURCE_LOCK emscripten)
