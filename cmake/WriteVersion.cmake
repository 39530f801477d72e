execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude=* OUTPUT_VARIABLE EDMILL_COMMIT
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT EDMILL_COMMIT)
  set(EDMILL_COMMIT unknown)
endif()
configure_file(${SOURCE}/src/core/base/version.cpp.in ${TARGET} @ONLY)
