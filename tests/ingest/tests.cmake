# SPDX-License-Identifier: Apache-2.0
umbrick_tests(ingest array_volume_test.cpp dicom_volume_test.cpp foreign_files_test.cpp frame_sequence_test.cpp fuzz_corpus_test.cpp hdf5_axes_test.cpp hdf5_volume_test.cpp image_stack_test.cpp length_unit_test.cpp metaimage_volume_test.cpp nifti_volume_test.cpp npy_volume_test.cpp nrrd_volume_test.cpp parts_test.cpp
                     packed_stream_test.cpp raw_volume_test.cpp read_ahead_test.cpp split_components_test.cpp tiff_place_test.cpp volume_time_test.cpp volume_values_test.cpp vtk_volume_test.cpp world_test.cpp ../fuzz/study_target.cpp OPENVDB ../fuzz/grid_targets.cpp dicom_colours_test.cpp dicom_kinds_test.cpp dicom_segments_test.cpp dicom_series_test.cpp)
target_include_directories(umbrick_ingest_tests SYSTEM PRIVATE ${ZSTD_INCLUDE_DIR} ${GDCM_INCLUDE_DIR} ${HDF5_INCLUDE_DIR}/hdf5/serial)
target_link_libraries(umbrick_ingest_tests PRIVATE PNG::PNG TIFF::TIFF ${LZ4_LIBRARY} ${HDF5_LIBRARY} ZLIB::ZLIB BZip2::BZip2 LibLZMA::LibLZMA ${ZSTD_LIBRARY} ${GDCM_LIBRARIES})
target_compile_definitions(umbrick_ingest_tests PRIVATE UMBRICK_FUZZ_CORPUS="${PROJECT_SOURCE_DIR}/tests/fuzz/corpus")
