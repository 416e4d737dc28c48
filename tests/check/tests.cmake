# SPDX-License-Identifier: Apache-2.0
umbrick_tests(check SLOW invariants_gl_test.cpp)
# The checks of single bricks and slices are internal.
target_include_directories(umbrick_check_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
