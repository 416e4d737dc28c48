# SPDX-License-Identifier: Apache-2.0
umbrick_tests(core camera_test.cpp json_test.cpp mebibytes_test.cpp pending_file_test.cpp pending_pair_test.cpp random_test.cpp pixel_points_test.cpp patient_space_test.cpp output_test.cpp)
# The JSON reader and writer are internal.
target_include_directories(umbrick_core_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
