umbrick_tests(slice proxy_slices_test.cpp)
