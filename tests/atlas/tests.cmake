# SPDX-License-Identifier: Apache-2.0
umbrick_tests(atlas brick_atlas_gl_test.cpp)
