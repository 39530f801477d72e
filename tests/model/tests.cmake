edmill_test(mill_motion_test model/mill_motion_test.cpp)
