umbrick_tests(scene scene_test.cpp)
