# Tests of the source tree.
set(architecture ${CMAKE_CURRENT_SOURCE_DIR}/architecture)
# Include folders that are not the compiler's own.
set(include_flags)
foreach(package Eigen3::Eigen hdf5::hdf5)
  get_target_property(folders ${package} INTERFACE_INCLUDE_DIRECTORIES)
  list(TRANSFORM folders PREPEND -I)
  list(APPEND include_flags ${folders})
endforeach()
add_test(NAME layers_test COMMAND ${architecture}/layers_test.sh)
add_test(NAME headers_test COMMAND ${architecture}/headers_test.sh ${CMAKE_CXX_COMPILER} ${include_flags} -DEIGEN_DONT_VECTORIZE)
find_program(CLANG_FORMAT clang-format)
if(CLANG_FORMAT)
  add_test(NAME format_test COMMAND ${architecture}/format_test.sh)
endif()

# What same_bits_test builds with each compiler: the core in double with its ladder, nothing else.
file(GLOB collision_bits_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/casefile/*.cpp ${CMAKE_SOURCE_DIR}/src/base/*.cpp
     ${CMAKE_SOURCE_DIR}/src/engine/*.cpp ${CMAKE_SOURCE_DIR}/src/io/csv_reader.cpp)
add_executable(collision_bits EXCLUDE_FROM_ALL ${architecture}/collision_bits.cpp ${collision_bits_sources})
target_link_libraries(collision_bits PRIVATE edmill_settings OpenSSL::Crypto tomlplusplus::tomlplusplus)
add_test(NAME same_bits_test COMMAND ${architecture}/same_bits_test.sh $<TARGET_FILE:edmill_cli> ${CMAKE_BINARY_DIR}/same-bits)
set_tests_properties(same_bits_test PROPERTIES TIMEOUT 1800 RUN_SERIAL TRUE)
