# SPDX-License-Identifier: Apache-2.0
if(UMBRICK_TOOLS)
  umbrick_tests(study_page commands_test.cpp page_test.cpp plot_script_test.cpp)
  target_link_libraries(umbrick_study_page_tests PRIVATE umbrick_study_page)
endif()
