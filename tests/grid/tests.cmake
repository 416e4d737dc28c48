# SPDX-License-Identifier: Apache-2.0
umbrick_tests(grid resample_test.cpp OPENVDB build_grid_test.cpp emission_grid_test.cpp grid_filters_test.cpp grid_world_test.cpp isosurface_test.cpp label_grids_test.cpp loss_test.cpp
              plan_test.cpp segment_grids_test.cpp source_filters_test.cpp stored_voxels_test.cpp usual_value_test.cpp value_survey_test.cpp vector_grid_test.cpp)
