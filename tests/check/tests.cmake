# SPDX-License-Identifier: Apache-2.0
umbrick_tests(check invariants_gl_test.cpp OPENVDB kit_export_test.cpp kit_verdict_test.cpp)
# The checks of single bricks and slices are internal.
target_include_directories(umbrick_check_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(umbrick_check_tests PRIVATE nlohmann_json::nlohmann_json)
