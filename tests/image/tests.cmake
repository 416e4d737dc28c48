umbrick_tests(image exr_test.cpp png_test.cpp)
