umbrick_tests(atlas brick_atlas_gl_test.cpp)
