umbrick_tests(grid resample_test.cpp OPENVDB build_grid_test.cpp grid_filters_test.cpp isosurface_test.cpp loss_test.cpp nano_file_test.cpp plan_test.cpp quantised_test.cpp source_filters_test.cpp
              stored_voxels_test.cpp vdb_file_test.cpp write_volume_test.cpp)
target_link_libraries(umbrick_grid_tests PRIVATE ZLIB::ZLIB ${BLOSC_LIBRARY})
target_include_directories(umbrick_grid_tests SYSTEM PRIVATE ${NANOVDB_INCLUDE_DIR})
