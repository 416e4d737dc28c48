# SPDX-License-Identifier: Apache-2.0
umbrick_tests(light extinction_table_test.cpp light_cut_test.cpp light_edit_test.cpp light_order_test.cpp light_spacing_test.cpp light_volume_test.cpp mesh_shadow_test.cpp sweep_kernels_test.cpp)
# Parts of the room that its public header does not show.
target_include_directories(umbrick_light_tests PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
