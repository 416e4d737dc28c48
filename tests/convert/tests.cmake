# SPDX-License-Identifier: Apache-2.0
umbrick_tests(convert OPENVDB convert_background_test.cpp convert_frames_test.cpp convert_grids_test.cpp convert_parts_test.cpp convert_segments_test.cpp convert_target_parts_test.cpp convert_target_test.cpp convert_volumes_test.cpp convert_world_test.cpp load_volume_test.cpp no_file_left_test.cpp
              source_order_test.cpp)
target_link_libraries(umbrick_convert_tests PRIVATE ZLIB::ZLIB)
