# Arb::Arb, the library of ball arithmetic: Debian 12 packages it as libflint-arb-dev; FLINT 3, of
# Debian 13, has it in itself.
find_path(ARB_INCLUDE_DIR arb.h PATH_SUFFIXES flint)
find_library(ARB_LIBRARY NAMES flint-arb arb flint)
find_library(FLINT_LIBRARY flint)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Arb DEFAULT_MSG ARB_LIBRARY FLINT_LIBRARY ARB_INCLUDE_DIR)
mark_as_advanced(ARB_INCLUDE_DIR ARB_LIBRARY FLINT_LIBRARY)
if(Arb_FOUND AND NOT TARGET Arb::Arb)
  add_library(Arb::Arb UNKNOWN IMPORTED)
  set_target_properties(Arb::Arb PROPERTIES IMPORTED_LOCATION ${ARB_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${ARB_INCLUDE_DIR}
                                            INTERFACE_LINK_LIBRARIES ${FLINT_LIBRARY})
endif()
