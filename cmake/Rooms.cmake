# edmill_library(name ROOMS room...): a static library of the sources of these folders of src/. Dependencies between rooms go one
# way, which tests/architecture checks.
function(edmill_library name)
  cmake_parse_arguments(ARG "" "" "ROOMS" ${ARGN})
  set(sources)
  foreach(room ${ARG_ROOMS})
    file(GLOB of_room CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${room}/*.cpp)
    list(APPEND sources ${of_room})
  endforeach()
  list(FILTER sources EXCLUDE REGEX "/main.cpp$")
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC edmill_settings)
  target_compile_options(${name} PRIVATE ${edmill_warnings})
endfunction()

# Sources that compile sooner at the price of speed: no loop over impacts is in them, or MPFR takes nearly all of its time.
function(edmill_compile_fast)
  foreach(pattern ${ARGN})
    file(GLOB of_pattern ${CMAKE_SOURCE_DIR}/src/${pattern})
    set_source_files_properties(${of_pattern} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O1>")
  endforeach()
endfunction()
