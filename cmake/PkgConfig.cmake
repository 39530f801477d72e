# edmill.pc in EDMILL_PC, for any folder of libraries: its prefix counts from where the file is, so
# that what is installed can be moved as a whole.
file(RELATIVE_PATH pc_up "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" /prefix)
string(REGEX REPLACE "/$" "" pc_prefix "\${pcfiledir}/${pc_up}")
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(pc_prefix ${CMAKE_INSTALL_PREFIX})
endif()
foreach(dir INCLUDEDIR LIBDIR)
  cmake_path(APPEND pc_${dir} "\${prefix}" "${CMAKE_INSTALL_${dir}}") # an absolute one takes its place
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/edmill.pc.in ${EDMILL_PC} @ONLY)
