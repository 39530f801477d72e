edmill_test(trigonometry_test numerics/trigonometry_test.cpp)
edmill_test(hermite_test numerics/hermite_test.cpp)
