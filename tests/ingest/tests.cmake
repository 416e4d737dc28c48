umbrick_tests(ingest nrrd_volume_test.cpp raw_volume_test.cpp)
target_link_libraries(umbrick_ingest_tests PRIVATE ZLIB::ZLIB)
