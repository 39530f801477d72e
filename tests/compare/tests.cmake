foreach(name log_reader_test batches_test comparison_test)
  edmill_test(${name} compare/${name}.cpp TIMEOUT 300)
endforeach()
