edmill_test(ticks_test plot/ticks_test.cpp)
edmill_test(chart_test plot/chart_test.cpp LIBRARIES pugixml::pugixml)
