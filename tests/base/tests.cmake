edmill_test(archive_test base/archive_test.cpp)
edmill_test(memory_test base/memory_test.cpp)
edmill_test(trigonometry_test base/trigonometry_test.cpp)
edmill_test(hermite_test base/hermite_test.cpp)
