# SPDX-License-Identifier: Apache-2.0
umbrick_tests(render OPENVDB volume_view_gl_test.cpp)
