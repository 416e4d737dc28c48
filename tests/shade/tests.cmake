# SPDX-License-Identifier: Apache-2.0
umbrick_tests(shade bad_input_gl_test.cpp closed_forms_gl_test.cpp convergence_gl_test.cpp emission_gl_test.cpp
              footprint_test.cpp hard_buffers_gl_test.cpp hard_cameras_gl_test.cpp hard_formulas_gl_test.cpp
              hard_transforms_gl_test.cpp lattice_tiles_test.cpp light_aim_test.cpp
              light_geometry_test.cpp light_plan_test.cpp march_gl_test.cpp occlusion_gl_test.cpp
              ordinates_convergence_gl_test.cpp ordinates_gl_test.cpp pixel_samples_gl_test.cpp progressive_gl_test.cpp ray_walk_test.cpp screen_region_test.cpp
              sweep_plan_test.cpp transfer_lookup_gl_test.cpp OPENVDB border_gl_test.cpp bright_lights_gl_test.cpp
              values_gl_test.cpp continuity_gl_test.cpp hard_grids_gl_test.cpp light_volume_gl_test.cpp hard_media_gl_test.cpp
              ordinates_hard_gl_test.cpp ray_caster_gl_test.cpp stacks_gl_test.cpp projection_gl_test.cpp shading_gl_test.cpp surface_gl_test.cpp surface_light_gl_test.cpp mesh_scene_gl_test.cpp
              light_sweep_gl_test.cpp cone_rays_gl_test.cpp hybrid_gl_test.cpp gradient_filter_gl_test.cpp fire_gl_test.cpp)
# Parts of the renderer that its public header does not show.
target_include_directories(umbrick_shade_tests PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
