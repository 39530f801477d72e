# The Python package as it stands in the build.
if(EDMILL_PYTHON)
  foreach(name rates_test run_test ends_test daemon_test arguments_test studies_test notebooks_test certainty_test digits_test host_arithmetic_test)
    add_test(NAME python_${name} COMMAND ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider ${CMAKE_CURRENT_SOURCE_DIR}/bindings/python/${name}.py)
    set_tests_properties(python_${name} PROPERTIES ENVIRONMENT
      "EDMILL=$<TARGET_FILE:edmill_cli>;PYTHONPATH=${CMAKE_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1")
  endforeach()
  set_property(TEST python_host_arithmetic_test APPEND PROPERTY ENVIRONMENT EDMILL_HOST_ARITHMETIC=$<TARGET_FILE:host_arithmetic>)
  add_test(NAME python_wheel_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/bindings/python/wheel_test.sh ${CMAKE_BINARY_DIR}/wheel)
  set_tests_properties(python_wheel_test PROPERTIES LABELS long TIMEOUT 3600)
endif()
