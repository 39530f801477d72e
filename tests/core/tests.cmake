edmill_test(archive_test core/archive_test.cpp)
