# `cmake --install` puts the program, the headers of include/edmill and the library edmill::edmill
# in place; other projects find it by find_package(edmill) or pkg-config. The components are
# packages of Debian: cmake/Packages.cmake.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
add_library(edmill INTERFACE)
add_library(edmill::edmill ALIAS edmill)
target_link_libraries(edmill INTERFACE edmill_run)
target_include_directories(edmill INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(edmill INTERFACE cxx_std_20)

install(TARGETS edmill_cli RUNTIME COMPONENT program)
add_custom_command(TARGET edmill_cli POST_BUILD VERBATIM
                   COMMAND sh -c "'$<TARGET_FILE:edmill_cli>' manual > edmill.1 && '$<TARGET_FILE:edmill_cli>' completion > edmill.bash"
                   WORKING_DIRECTORY ${CMAKE_BINARY_DIR} BYPRODUCTS edmill.1 edmill.bash)
install(FILES ${CMAKE_BINARY_DIR}/edmill.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/edmill.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME edmill
        COMPONENT program)

install(TARGETS edmill edmill_run edmill_case edmill_files edmill_core edmill_settings EXPORT edmill-targets COMPONENT dev)
install(DIRECTORY include/edmill TYPE INCLUDE COMPONENT dev)
install(EXPORT edmill-targets NAMESPACE edmill:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill COMPONENT dev)
configure_package_config_file(cmake/edmill-config.cmake.in ${CMAKE_BINARY_DIR}/edmill-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/edmill-config-version.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_BINARY_DIR}/edmill-config.cmake ${CMAKE_BINARY_DIR}/edmill-config-version.cmake cmake/FindGMP.cmake
              cmake/FindHDF5C.cmake cmake/FindMPFR.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/edmill COMPONENT dev)
set(EDMILL_PC ${CMAKE_BINARY_DIR}/edmill.pc)
include(cmake/PkgConfig.cmake)
install(FILES ${CMAKE_BINARY_DIR}/edmill.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

if(EDMILL_PYTHON)
  set(python_folder lib/python3/dist-packages/edmill)
  install(TARGETS edmill_python LIBRARY DESTINATION ${python_folder} COMPONENT python)
  install(FILES ${package_files} DESTINATION ${python_folder} COMPONENT python)
endif()

install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT doc)
# The manual, once docs/sphinx/make.sh has made it.
install(DIRECTORY ${CMAKE_BINARY_DIR}/manual/html DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc OPTIONAL
        PATTERN _sources EXCLUDE)
# The mill in a browser, once it has been built (docs/portability.md).
install(FILES ${CMAKE_SOURCE_DIR}/build/page/edmill.html DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc OPTIONAL)
include(cmake/Packages.cmake)
