# The core alone: runs in double and float128 by the standard library and header files of Boost,
# Eigen, fmt and toml++, which any compiler for any machine reads. cmake -DEDMILL_CORE_ALONE=ON
# [-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_CXX_COMPILER=s390x-linux-gnu-g++] By Emscripten it makes the
# page, too: the mill in a browser, in one file.

# Links to these headers, so that nothing else of this machine is included.
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
function(edmill_take_headers)
  foreach(header ${ARGN})
    get_filename_component(name ${header} DIRECTORY)
    find_path(${name}_folder NAMES ${header} PATHS /usr/include PATH_SUFFIXES eigen3 NO_CMAKE_FIND_ROOT_PATH REQUIRED)
    file(CREATE_LINK ${${name}_folder}/${name} ${headers}/${name} SYMBOLIC)
  endforeach()
endfunction()
edmill_take_headers(boost/version.hpp fmt/format.h toml++/toml.h Eigen/Core)

add_library(edmill_core_settings INTERFACE)
target_compile_definitions(edmill_core_settings INTERFACE EDMILL_WITHOUT_MPFR EDMILL_PORTABLE_FLOAT128 FMT_HEADER_ONLY
                                                          TOML_HEADER_ONLY=0 TOML_ENABLE_FORMATTERS=0 EIGEN_DONT_VECTORIZE)
target_include_directories(edmill_core_settings INTERFACE ${CMAKE_SOURCE_DIR}/include)
foreach(library core files case run pages judge program bindings)
  target_include_directories(edmill_core_settings INTERFACE ${CMAKE_SOURCE_DIR}/src/${library})
endforeach()
target_include_directories(edmill_core_settings SYSTEM INTERFACE ${headers})
target_compile_options(edmill_core_settings INTERFACE ${edmill_bits} ${edmill_warnings})
if(EMSCRIPTEN)
  target_compile_options(edmill_core_settings INTERFACE -fwasm-exceptions -msimd128 -Wno-sign-conversion -Wno-shorten-64-to-32)
  target_link_options(edmill_core_settings INTERFACE -O2 -fwasm-exceptions -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=4194304)
endif()

include(cmake/Rooms.cmake)

# edmill_take_rooms(target library/room...)
function(edmill_take_rooms target)
  foreach(folder ${ARGN})
    get_filename_component(room ${folder} NAME)
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${folder}/*.cpp)
    # What needs other libraries, for which core_alone/absent.cpp stands, MPFR and programs.
    list(FILTER sources EXCLUDE REGEX "(table_hdf5|decoder|event_file|scene|mpfr|sensitivity|make_run|main)[.]cpp$")
    target_sources(${target} PRIVATE ${sources})
    if(NOT room STREQUAL core_alone)
      edmill_group(${room} ${sources})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${EDMILL_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# Linkers keep the first copy of an inline function: that of double comes before those of wide
# scalars, which WebAssembly compiles for size (functions of double that they share took three times
# as long).
set(double src/core/engine/double.cpp src/core/engine/double_other.cpp src/run/run/double.cpp src/run/output/double.cpp)
set(wide src/core/engine/float128.cpp src/core/engine/mpfr50.cpp src/run/run/float128.cpp src/run/output/float128.cpp)
if(EMSCRIPTEN)
  edmill_alone(${double} ${wide})
endif()
add_library(edmill_core OBJECT ${double} ${EDMILL_VERSION_SOURCE})
target_link_libraries(edmill_core PUBLIC edmill_core_settings)
target_precompile_headers(edmill_core PRIVATE <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <sstream>
  <string> <variant> <vector> <boost/container/static_vector.hpp> <boost/multiprecision/cpp_int.hpp> <boost/multiprecision/cpp_bin_float.hpp>
  <boost/multiprecision/eigen.hpp> <Eigen/Geometry> <fmt/format.h> <toml++/toml.h>)
edmill_take_rooms(edmill_core core/base core/model core/dynamics core/engine core/tangent files/io case/casefile run/output run/run bindings/core_alone)
edmill_together(double ${double})
edmill_together(wide ${wide})
set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/bindings/core_alone/toml.cpp PROPERTY SKIP_PRECOMPILE_HEADERS ON)
add_executable(edmill_core_alone src/bindings/core_alone/main.cpp src/program/app/run.cpp src/program/cli/exit_codes.cpp
               src/pages/report/result_table.cpp src/run/run/make_run.cpp)
set_target_properties(edmill_core_alone PROPERTIES OUTPUT_NAME edmill-core)
target_link_libraries(edmill_core_alone PRIVATE edmill_core)

if(EMSCRIPTEN)
  target_link_options(edmill_core_alone PRIVATE -sNODERAWFS=1)
  edmill_take_headers(nlohmann/json.hpp)
  file(MAKE_DIRECTORY ${headers}/unsupported)
  edmill_take_headers(unsupported/Eigen/NonLinearOptimization)
  include(cmake/Embed.cmake)
  # What judges logs, and the checker of certificates, which has no code of edmill: for the page and
  # for node.
  file(GLOB checker CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/verification/checker/*.cpp)
  list(FILTER checker EXCLUDE REGEX "/main.cpp$")
  set_source_files_properties(${checker} PROPERTIES UNITY_GROUP checker COMPILE_DEFINITIONS CHECKER_WITHOUT_ARB)
  add_library(edmill_judges OBJECT ${checker})
  target_link_libraries(edmill_judges PUBLIC edmill_core_settings)
  target_include_directories(edmill_judges PUBLIC ${CMAKE_SOURCE_DIR}/verification/checker)
  edmill_take_rooms(edmill_judges judge/logs judge/audit judge/compare judge/identify case/machines)
  edmill_embed(edmill_judges ${CMAKE_SOURCE_DIR}/src/case/machines/machines.toml machines_toml machines)

  add_executable(edmill_page)
  target_link_libraries(edmill_page PRIVATE edmill_core edmill_judges)
  edmill_take_rooms(edmill_page bindings/browser)
  # The file is to stay small; wide scalars decide seldom.
  set_source_files_properties(${wide} PROPERTIES COMPILE_OPTIONS -Os SKIP_PRECOMPILE_HEADERS ON)
  target_compile_options(edmill_page PRIVATE -Os)
  target_link_options(edmill_page PRIVATE -sMALLOC=emmalloc)
  target_link_options(edmill_page PRIVATE -sMODULARIZE=1 -sEXPORT_NAME=Edmill -sENVIRONMENT=web,worker
                      -sEXPORTED_RUNTIME_METHODS=ccall,FS -sEXPORTED_FUNCTIONS=_malloc,_free)
  set(page ${CMAKE_BINARY_DIR}/edmill.html)
  find_program(PYTHON3 python3 NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  file(GLOB parts CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/bindings/browser/*.html ${CMAKE_SOURCE_DIR}/src/bindings/browser/*.css ${CMAKE_SOURCE_DIR}/src/bindings/browser/*.js
       ${CMAKE_SOURCE_DIR}/src/pages/report/mill_view.js)
  add_custom_command(OUTPUT ${page} DEPENDS edmill_page ${parts} ${CMAKE_SOURCE_DIR}/cmake/assemble_page.py
                     COMMAND ${PYTHON3} ${CMAKE_SOURCE_DIR}/cmake/assemble_page.py ${CMAKE_BINARY_DIR}/edmill_page ${page} VERBATIM)
  add_custom_target(page ALL DEPENDS ${page})

  # The program for node: all its commands, of which those that need more than the core refuse to
  # run.
  edmill_take_headers(CLI/CLI.hpp)
  add_executable(edmill_node)
  target_link_libraries(edmill_node PRIVATE edmill_core edmill_judges)
  edmill_take_rooms(edmill_node bindings/node judge/dem case/decks)
  target_sources(edmill_node PRIVATE src/program/cli/main.cpp src/program/cli/exit_codes.cpp src/program/app/run.cpp src/program/app/judge.cpp
                 src/pages/report/result_table.cpp src/run/run/make_run.cpp)
  foreach(text lammps lammps_frame liggghts pose yade yade_planes yade_triangles)
    edmill_embed(edmill_node ${CMAKE_SOURCE_DIR}/src/case/decks/${text}.in ${text}_in decks)
  endforeach()
  edmill_embed(edmill_node ${CMAKE_SOURCE_DIR}/docs/examples/demo.toml)
  target_compile_definitions(edmill_node PRIVATE EDMILL_NODE)
  target_include_directories(edmill_node BEFORE PRIVATE ${CMAKE_SOURCE_DIR}/src/bindings/node/without_mpfr)
  target_link_options(edmill_node PRIVATE -sNODERAWFS=1 -sMAXIMUM_MEMORY=4GB -sENVIRONMENT=node -sMODULARIZE=1 -sEXPORT_NAME=Edmill
                      -sEXPORTED_RUNTIME_METHODS=ENV,FS)
  set(npm ${CMAKE_BINARY_DIR}/npm/edmill-${PROJECT_VERSION}.tgz)
  file(GLOB parts CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/bindings/node/*.js ${CMAKE_SOURCE_DIR}/src/bindings/node/*.mjs
       ${CMAKE_SOURCE_DIR}/src/bindings/node/*.json ${CMAKE_SOURCE_DIR}/src/bindings/node/*.md)
  add_custom_command(OUTPUT ${npm} DEPENDS edmill_node ${parts} ${CMAKE_SOURCE_DIR}/cmake/assemble_package.py
                     COMMAND ${PYTHON3} ${CMAKE_SOURCE_DIR}/cmake/assemble_package.py ${CMAKE_BINARY_DIR}/edmill_node ${CMAKE_BINARY_DIR}/npm
                     VERBATIM)
  add_custom_target(npm ALL DEPENDS ${npm})
endif()
