# SPDX-License-Identifier: Apache-2.0
umbrick_tests(gl context_gl_test.cpp objects_gl_test.cpp program_gl_test.cpp)
