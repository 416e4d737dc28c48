# SPDX-License-Identifier: Apache-2.0
umbrick_tests(sweep brick_rows_test.cpp medium_table_test.cpp ray_lattice_test.cpp row_kernels_test.cpp
              OPENVDB brick_bands_test.cpp classification_test.cpp cone_rays_test.cpp gradient_filter_test.cpp cpu_hard_test.cpp cpu_light_test.cpp cpu_progressive_test.cpp cpu_test.cpp emission_light_test.cpp emission_test.cpp
                      hybrid_test.cpp mesh_scene_test.cpp projection_test.cpp shading_test.cpp surface_light_test.cpp surface_test.cpp)
# Parts of the room that its public header does not show.
target_include_directories(umbrick_sweep_tests PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
