edmill_test(lasting_contacts_test dem/lasting_contacts_test.cpp TIMEOUT 600)
edmill_test(soft_contact_test dem/soft_contact_test.cpp)
edmill_test(frame_reader_test dem/frame_reader_test.cpp)
add_executable(small_dem_dump dem/small_dem_dump.cpp)
target_compile_features(small_dem_dump PRIVATE cxx_std_20)
set(dem_environment "PYTHONPATH=${CMAKE_BINARY_DIR}/python" PYTHONDONTWRITEBYTECODE=1)
add_test(NAME dem_commands_test COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_SOURCE_DIR}/dem/dem_commands_test.py
         $<TARGET_FILE:edmill_cli> $<TARGET_FILE:small_dem_dump>)
set_tests_properties(dem_commands_test PROPERTIES TIMEOUT 600 ENVIRONMENT "${dem_environment}")
