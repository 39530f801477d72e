# Writes version.cpp with the present commit at every build, touching it only when it changes. The
# target's property PARTS lists what is optional and was found.
set(EDMILL_VERSION_SOURCE ${CMAKE_BINARY_DIR}/version.cpp)
set(EDMILL_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}")
add_custom_target(edmill_version
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DTARGET=${EDMILL_VERSION_SOURCE}
          -DEDMILL_VERSION=${PROJECT_VERSION} "-DEDMILL_COMPILER=${EDMILL_COMPILER}"
          "-DEDMILL_PARTS=$<JOIN:$<TARGET_PROPERTY:edmill_version,PARTS>,, >"
          -P ${CMAKE_SOURCE_DIR}/cmake/WriteVersion.cmake
  BYPRODUCTS ${EDMILL_VERSION_SOURCE} VERBATIM)
