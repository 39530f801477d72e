# `cmake --install` puts the program, the headers of include/edmill and the library edmill::edmill in place; other projects find
# it by find_package(edmill).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
add_library(edmill INTERFACE)
add_library(edmill::edmill ALIAS edmill)
target_link_libraries(edmill INTERFACE edmill_core)
target_include_directories(edmill INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(edmill INTERFACE cxx_std_20)

install(TARGETS edmill_cli RUNTIME)
install(TARGETS edmill edmill_core edmill_settings EXPORT edmill-targets)
install(DIRECTORY include/edmill TYPE INCLUDE)
install(EXPORT edmill-targets NAMESPACE edmill:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill)
configure_package_config_file(cmake/edmill-config.cmake.in ${CMAKE_BINARY_DIR}/edmill-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/edmill-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/edmill-config.cmake ${CMAKE_BINARY_DIR}/edmill-config-version.cmake cmake/FindGMP.cmake
              cmake/FindMPFR.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill)
