# Tests of the source tree.
set(architecture ${CMAKE_CURRENT_SOURCE_DIR}/architecture)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME source_test COMMAND Python3::Interpreter ${architecture}/source_test.py ${CMAKE_SOURCE_DIR})
add_test(NAME workflows_test COMMAND ${DEBIAN_PYTHON3} ${architecture}/workflows_test.py ${CMAKE_SOURCE_DIR})
add_test(NAME oldest_python_test COMMAND Python3::Interpreter ${architecture}/oldest_python_test.py ${CMAKE_SOURCE_DIR})
add_test(NAME headers_test COMMAND ${architecture}/headers_test.sh ${CMAKE_CXX_COMPILER})
find_program(CLANG_FORMAT clang-format)
if(CLANG_FORMAT)
  add_test(NAME format_test COMMAND ${architecture}/format_test.sh)
  set_tests_properties(format_test PROPERTIES SKIP_RETURN_CODE 77)
endif()
add_test(NAME examples_test
         COMMAND ${architecture}/examples_test.sh ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}/examples ${CMAKE_CXX_COMPILER})
set_tests_properties(examples_test PROPERTIES TIMEOUT 600)
add_test(NAME extending_test COMMAND ${architecture}/extending_test.sh ${CMAKE_BINARY_DIR}/extending)
add_test(NAME extending_long
         COMMAND ${architecture}/extending_test.sh ${CMAKE_BINARY_DIR}/extending-long ${CMAKE_CXX_COMPILER} ${CMAKE_BINARY_DIR}
                 ${DEBIAN_PYTHON3})
set_tests_properties(extending_long PROPERTIES LABELS long TIMEOUT 1800)

# A program of the core, for other trees and compilers.
add_executable(collision_bits EXCLUDE_FROM_ALL ${architecture}/collision_bits.cpp)
target_link_libraries(collision_bits PRIVATE edmill_run)

# In CI the processor that differs most: its bytes are in the other order.
add_test(NAME same_bits_test
         COMMAND ${architecture}/same_bits_test.sh $<TARGET_FILE:edmill_cli> ${CMAKE_BINARY_DIR}/same-bits --every 5 s390x)
add_test(NAME same_bits_long COMMAND ${architecture}/same_bits_test.sh $<TARGET_FILE:edmill_cli> ${CMAKE_BINARY_DIR}/same-bits-long
                                     g++-O0 g++-native clang++ aarch64 riscv64 s390x wasm32)
set_tests_properties(same_bits_test PROPERTIES TIMEOUT 1800 PROCESSORS 2)
set_tests_properties(same_bits_long PROPERTIES LABELS long TIMEOUT 7200)

# The README's commands, and debian/, on fresh releases of Debian.
foreach(release bookworm trixie)
  add_test(NAME debian_${release}_long COMMAND ${architecture}/debian_test.sh ${release} ${CMAKE_BINARY_DIR}/debian-${release} demo test)
  add_test(NAME debian_package_${release}_long
           COMMAND ${architecture}/debian_package_test.sh ${release} ${CMAKE_BINARY_DIR}/debian-package-${release})
  set_tests_properties(debian_${release}_long debian_package_${release}_long
                       PROPERTIES LABELS long TIMEOUT 14400 SKIP_RETURN_CODE 77)
endforeach()
