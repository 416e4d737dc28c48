# SPDX-License-Identifier: Apache-2.0
umbrick_tests(scene annotations_test.cpp scene_keys_test.cpp scene_test.cpp scene_fields_test.cpp capabilities_test.cpp emission_test.cpp gradient_opacity_test.cpp lights_test.cpp environment_test.cpp)
# The text of single fields is internal.
target_include_directories(umbrick_scene_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
