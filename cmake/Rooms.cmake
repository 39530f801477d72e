# Several sources in one compilation: most of the compile time of a small one goes into the headers
# that it shares with others.
option(EDMILL_UNITY "compile sources of a room several at a time" ON)

# edmill_library(name room... LINK library...): a static library of these folders of src/<name>, and
# what it may include.
function(edmill_library name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  set(library edmill_${name})
  add_library(${library} STATIC)
  foreach(room ${ARG_UNPARSED_ARGUMENTS})
    file(GLOB of_room CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/${room}/*.cpp)
    list(FILTER of_room EXCLUDE REGEX "/main.cpp$")
    target_sources(${library} PRIVATE ${of_room})
    edmill_group(${room} ${of_room})
  endforeach()
  target_include_directories(${library} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src/${name}>)
  target_link_libraries(${library} PUBLIC ${ARG_LINK})
  target_compile_options(${library} PRIVATE ${edmill_warnings} $<$<CONFIG:Release>:-O1>)
  set_target_properties(${library} PROPERTIES UNITY_BUILD ${EDMILL_UNITY} UNITY_BUILD_MODE GROUP)
  edmill_reuse_precompiled(${library} edmill_precompiled)
endfunction()

# edmill_group(room source...): groups of eight, so that a change does not compile too many others
# again.
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

# edmill_together(group source...): large sources that share most of their templates, in one
# compilation.
function(edmill_together group)
  foreach(source ${ARGN})
    set_property(SOURCE ${CMAKE_SOURCE_DIR}/${source} PROPERTY UNITY_GROUP ${group})
  endforeach()
endfunction()

# Sources with all optimisations, without a precompiled header: GCC compiles what follows one with
# the optimisations of the header.
function(edmill_optimise)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endfunction()
