# SPDX-License-Identifier: Apache-2.0
if(UMBRICK_TOOLS)
  umbrick_tests(view comparison_test.cpp file_opening_test.cpp message_fuzz_test.cpp open_folder_test.cpp sequence_test.cpp server_test.cpp surface_value_test.cpp view_state_test.cpp viewer_test.cpp
                ../fuzz/message_target.cpp)
  target_link_libraries(umbrick_view_tests PRIVATE umbrick_view Boost::headers ZLIB::ZLIB)
  # Headers of the viewer use private ones of core.
  target_include_directories(umbrick_view_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(umbrick_view_tests PRIVATE UMBRICK_FUZZ_CORPUS="${PROJECT_SOURCE_DIR}/tests/fuzz/corpus")
  add_dependencies(umbrick_view_tests umbrick_tool)

  # The page: its logic by Node, and all of it in a browser.
  add_test(NAME "view: the page's modules do what they say"
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/view_page/run_modules ${CMAKE_CURRENT_SOURCE_DIR}/view_page)
  add_test(NAME "view: a browser turns, edits, undoes, clips and saves"
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/view_page/run_page $<TARGET_FILE:umbrick_tool> ${PROJECT_SOURCE_DIR}/assets)
  set_tests_properties("view: the page's modules do what they say" "view: a browser turns, edits, undoes, clips and saves"
                       PROPERTIES SKIP_RETURN_CODE 77)
  # The page takes the same code of the program as with the other tests, and many times as long with sanitizers.
  set_tests_properties("view: a browser turns, edits, undoes, clips and saves" PROPERTIES LABELS "slow")
endif()
