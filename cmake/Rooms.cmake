# Several sources in one compilation: most of the compile time of a small one goes into the headers that it shares with others.
option(EDMILL_UNITY "compile sources of a room several at a time" ON)

# edmill_library(name room...): a static library of the sources of these folders of src/.
function(edmill_library name)
  add_library(${name} STATIC)
  foreach(room ${ARGN})
    file(GLOB of_room CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${room}/*.cpp)
    list(FILTER of_room EXCLUDE REGEX "/main.cpp$")
    target_sources(${name} PRIVATE ${of_room})
    edmill_group(${room} ${of_room})
  endforeach()
  target_link_libraries(${name} PUBLIC edmill_settings)
  target_compile_options(${name} PRIVATE ${edmill_warnings} $<$<CONFIG:Release>:-O1>)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${EDMILL_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# edmill_group(room source...): groups of eight, so that a change does not compile too many others again.
function(edmill_group room)
  set(count 0)
  foreach(source ${ARGN})
    math(EXPR group "${count} / 8")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${room}_${group})
    math(EXPR count "${count} + 1")
  endforeach()
endfunction()

# edmill_alone(source...): large sources, each compiled by itself.
function(edmill_alone)
  foreach(source ${ARGN})
    set_property(SOURCE ${CMAKE_SOURCE_DIR}/${source} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()

# Sources with all optimisations, without a precompiled header: GCC compiles what follows one with the optimisations of the header.
function(edmill_optimise)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endfunction()
