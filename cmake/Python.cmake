# The package edmill for Python, in python/edmill of the build: the extension module _edmill beside
# links to its Python sources.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3) # Debian's, which pybind11 and NumPy are for
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.10 REQUIRED)

file(GLOB python_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/bindings/python/*.cpp)
pybind11_add_module(edmill_python MODULE NO_EXTRAS ${python_sources})
target_include_directories(edmill_python PRIVATE ${CMAKE_SOURCE_DIR}/src/bindings)
target_link_libraries(edmill_python PRIVATE edmill_program)
target_compile_options(edmill_python PRIVATE ${edmill_warnings} $<$<CONFIG:Release>:-O1>)
set(python_package ${CMAKE_BINARY_DIR}/python/edmill)
set_target_properties(edmill_python PROPERTIES UNITY_BUILD ${EDMILL_UNITY} OUTPUT_NAME _edmill LIBRARY_OUTPUT_DIRECTORY ${python_package})

file(GLOB package_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/bindings/python/edmill/*.py ${CMAKE_SOURCE_DIR}/src/bindings/python/edmill/*.pyi
     ${CMAKE_SOURCE_DIR}/src/bindings/python/edmill/py.typed)
file(MAKE_DIRECTORY ${python_package})
foreach(file ${package_files})
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${python_package}/${name} SYMBOLIC)
endforeach()
