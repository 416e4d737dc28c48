# The programs of tools/examples, on bundled volumes.
# SPDX-License-Identifier: Apache-2.0
add_subdirectory(${PROJECT_SOURCE_DIR}/tools/examples ${PROJECT_BINARY_DIR}/tools/examples)
set(smoke ${PROJECT_SOURCE_DIR}/assets/densityAndHeat.vdb)
set(head ${PROJECT_SOURCE_DIR}/assets/headsq_256x256x94_uint16le.raw.gz)
set(folder ${CMAKE_CURRENT_BINARY_DIR}/examples)
file(MAKE_DIRECTORY ${folder})
add_test(NAME "examples: a picture is rendered and compared with the reference"
         COMMAND umbrick_example_render_and_compare ${smoke} ${folder}/smoke.png)
add_test(NAME "examples: a scan is converted" COMMAND umbrick_example_convert_a_scan ${head} ${folder}/head.vdb 256 256 94)
add_test(NAME "examples: a renderer of one's own is tested" COMMAND umbrick_example_test_own_renderer ${smoke})
set_tests_properties("examples: a picture is rendered and compared with the reference" "examples: a scan is converted"
                     "examples: a renderer of one's own is tested" PROPERTIES ENVIRONMENT ${leak_options})
