# SPDX-License-Identifier: Apache-2.0
if(UMBRICK_TOOLS)
  umbrick_tests(tools compare_test.cpp convert_info_test.cpp convert_isosurface_test.cpp convert_kinds_test.cpp convert_memory_test.cpp convert_output_test.cpp convert_parts_test.cpp
              convert_plan_test.cpp convert_resample_test.cpp convert_safety_test.cpp convert_sequence_test.cpp convert_several_test.cpp info_volume_test.cpp
              interrupt_gl_test.cpp outputs_gl_test.cpp film_test.cpp check_kit_test.cpp manual_test.cpp render_frames_gl_test.cpp render_keys_gl_test.cpp progress_test.cpp render_check_gl_test.cpp study_gl_test.cpp usage_test.cpp foreign_input_test.cpp memory_limits_gl_test.cpp mutations_test.cpp
              OPENVDB first_picture_gl_test.cpp hard_volumes_gl_test.cpp progressive_gl_test.cpp pixel_samples_gl_test.cpp look_gl_test.cpp
              kill_test.cpp modes_test.cpp outputs_test.cpp reference_test.cpp signals_test.cpp)
  target_link_libraries(umbrick_tools_tests PRIVATE ZLIB::ZLIB nlohmann_json::nlohmann_json)
  add_dependencies(umbrick_tools_tests umbrick_tool)
  target_compile_definitions(umbrick_tools_tests PRIVATE UMBRICK_FUZZ_CORPUS="${PROJECT_SOURCE_DIR}/tests/fuzz/corpus")
  # When a job says how far it is, which no test waits for.
  target_sources(umbrick_tools_tests PRIVATE ${PROJECT_SOURCE_DIR}/tools/progress_pace.cpp)
  target_include_directories(umbrick_tools_tests PRIVATE ${PROJECT_SOURCE_DIR})

  add_test(NAME "tools: Blender reads what --to blender makes"
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/blender_reads $<TARGET_FILE:umbrick_tool> ${PROJECT_SOURCE_DIR}/assets)
  set_tests_properties("tools: Blender reads what --to blender makes" PROPERTIES SKIP_RETURN_CODE 77)

  add_test(NAME "tools: tools/README.md quotes what --help prints"
           COMMAND ${PROJECT_SOURCE_DIR}/tools/make_readme --check $<TARGET_FILE:umbrick_tool>)
endif()
