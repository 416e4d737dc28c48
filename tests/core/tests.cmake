umbrick_tests(core camera_test.cpp pending_file_test.cpp)
