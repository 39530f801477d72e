edmill_test(archive_test core/archive_test.cpp)
edmill_test(memory_test core/memory_test.cpp)
