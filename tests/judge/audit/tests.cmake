foreach(name event_log_test faults_test separation_test clean_logs_test late_logs_test)
  edmill_test(${name} audit/${name}.cpp TIMEOUT 300)
endforeach()
edmill_test(names_test audit/names_test.cpp LONG TIMEOUT 600)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME wrong_script_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/judge/audit/wrong_script_test.py
                                        $<TARGET_FILE:edmill_cli>)
set_tests_properties(wrong_script_test PROPERTIES TIMEOUT 300)
