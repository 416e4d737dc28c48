# SPDX-License-Identifier: Apache-2.0
umbrick_tests(mesh mesh_file_test.cpp mesh_test.cpp)
