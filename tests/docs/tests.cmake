# The pages of tools/docs that lead through a job do what they say.
# SPDX-License-Identifier: Apache-2.0
if(UMBRICK_TOOLS)
  foreach(walk from_scan_to_picture simulation_over_time what_accuracy_costs)
    set(name "docs: the walk ${walk} does what it says")
    add_test(NAME ${name} COMMAND ${CMAKE_CURRENT_LIST_DIR}/run_walk $<TARGET_FILE:umbrick_tool> ${PROJECT_SOURCE_DIR}/assets
                                  ${PROJECT_SOURCE_DIR}/tools/docs/${walk}.md)
    # Tests of the program run the same code on less.
    set_tests_properties(${name} PROPERTIES LABELS slow)
  endforeach()
endif()
