edmill_test(checkpoint_file_test io/checkpoint_file_test.cpp)
edmill_test(csv_reader_test io/csv_reader_test.cpp)
edmill_test(table_test io/table_test.cpp LIBRARIES hdf5::hdf5)
edmill_test(final_state_test io/final_state_test.cpp)
