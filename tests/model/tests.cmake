edmill_test(spex_motion_test model/spex_motion_test.cpp)
edmill_test(partners_test model/partners_test.cpp)
edmill_test(surface_test model/surface_test.cpp)
edmill_test(polyhedron_test model/polyhedron_test.cpp)
