# SPDX-License-Identifier: Apache-2.0
umbrick_tests(vdb OPENVDB nano_file_test.cpp quantised_test.cpp vdb_file_test.cpp write_volume_test.cpp)
target_link_libraries(umbrick_vdb_tests PRIVATE ZLIB::ZLIB ${BLOSC_LIBRARY})
target_include_directories(umbrick_vdb_tests SYSTEM PRIVATE ${NANOVDB_INCLUDE_DIR})
