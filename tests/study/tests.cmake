# SPDX-License-Identifier: Apache-2.0
umbrick_tests(study SLOW earlier_study_test.cpp statistics_test.cpp study_findings_test.cpp study_plan_test.cpp
              study_record_test.cpp study_table_test.cpp study_timing_test.cpp OPENVDB study_gl_test.cpp)
# How pictures are timed is internal.
target_include_directories(umbrick_study_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(umbrick_study_tests PRIVATE nlohmann_json::nlohmann_json)
