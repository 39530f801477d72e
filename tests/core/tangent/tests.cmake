edmill_test(tangent_map_test tangent/tangent_map_test.cpp TIMEOUT 300)
edmill_test(spectrum_test tangent/spectrum_test.cpp TIMEOUT 300)
