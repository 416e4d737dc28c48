umbrick_tests(brick brick_voxels_test.cpp brick_ranges_test.cpp)
