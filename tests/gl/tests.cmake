# SPDX-License-Identifier: Apache-2.0
umbrick_tests(gl context_gl_test.cpp objects_gl_test.cpp program_gl_test.cpp)
# The loading of libraries is internal.
target_include_directories(umbrick_gl_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
