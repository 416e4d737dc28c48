# SPDX-License-Identifier: Apache-2.0
umbrick_tests(core camera_test.cpp extremes_test.cpp input_file_test.cpp json_test.cpp mebibytes_test.cpp memory_test.cpp pending_file_test.cpp pending_pair_test.cpp printable_test.cpp random_test.cpp pixel_points_test.cpp patient_space_test.cpp output_test.cpp turned_camera_test.cpp)
# The JSON reader and writer are internal.
target_include_directories(umbrick_core_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(umbrick_core_tests PRIVATE nlohmann_json::nlohmann_json)
