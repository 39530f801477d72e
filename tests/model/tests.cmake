edmill_test(mill_motion_test model/mill_motion_test.cpp)
edmill_test(partners_test model/partners_test.cpp)
edmill_test(surface_test model/surface_test.cpp)
