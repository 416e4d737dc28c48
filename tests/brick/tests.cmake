# SPDX-License-Identifier: Apache-2.0
umbrick_tests(brick OPENVDB brick_voxels_test.cpp brick_ranges_test.cpp)
