umbrick_tests(optics medium_test.cpp)
