# Several sources in one compilation: most of the compile time of a small one goes into the headers that it shares with others.
option(EDMILL_UNITY "compile sources of a room several at a time" ON)

# edmill_library(name ROOMS room... LIGHT room...): a static library of the sources of these folders of src/. Dependencies between
# rooms go one way, which tests/architecture checks. What edmill_optimise does not name is compiled with fewer optimisations, LIGHT
# rooms several sources at a time.
function(edmill_library name)
  cmake_parse_arguments(ARG "" "" "ROOMS;LIGHT" ${ARGN})
  add_library(${name} STATIC)
  foreach(room ${ARG_ROOMS} ${ARG_LIGHT})
    file(GLOB of_room CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${room}/*.cpp)
    list(FILTER of_room EXCLUDE REGEX "/main.cpp$")
    target_sources(${name} PRIVATE ${of_room})
    if(room IN_LIST ARG_LIGHT)
      edmill_group(${room} ${of_room})
    endif()
  endforeach()
  target_link_libraries(${name} PUBLIC edmill_settings)
  target_compile_options(${name} PRIVATE ${edmill_warnings} $<$<CONFIG:Release>:-O1>)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${EDMILL_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# Sources with all optimisations, without a precompiled header: GCC compiles what follows one with the optimisations of the header.
function(edmill_optimise)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# edmill_group(room source...): groups of six, so that a change does not compile too many others again.
function(edmill_group room)
  set(count 0)
  foreach(source ${ARGN})
    math(EXPR group "${count} / 6")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${room}_${group})
    math(EXPR count "${count} + 1")
  endforeach()
endfunction()

# Wide scalars are most of the compile time. Without optimisation they compile in half of it and run at half their speed.
option(EDMILL_QUICK "compile wide scalars without optimisation" OFF)
if(EDMILL_QUICK)
  set(edmill_wide_optimisation -O0)
else()
  set(edmill_wide_optimisation -O1)
endif()

# Sources that compile sooner at the price of speed, which MPFR and the arithmetic of binary128 take nearly all of.
function(edmill_compile_fast)
  foreach(source ${ARGN})
    set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/${source} APPEND PROPERTY COMPILE_OPTIONS
                 $<$<CONFIG:Release>:${edmill_wide_optimisation}>)
    if(EDMILL_QUICK)  # precompiled headers are for optimised code
      set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/${source} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()
