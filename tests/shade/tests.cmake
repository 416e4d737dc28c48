umbrick_tests(shade emission_gl_test.cpp)
# Parts of the renderer that its public header does not show.
target_include_directories(umbrick_shade_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
