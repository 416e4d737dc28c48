# Random scenes: a hundred of them as a test, and the program for as many as one likes (tests/fuzz/pictures/run).
# SPDX-License-Identifier: Apache-2.0
add_library(umbrick_random_pictures OBJECT
            ${CMAKE_CURRENT_LIST_DIR}/random_grid.cpp ${CMAKE_CURRENT_LIST_DIR}/random_scene.cpp
            ${CMAKE_CURRENT_LIST_DIR}/slab_picture.cpp ${CMAKE_CURRENT_LIST_DIR}/same_scene.cpp
            ${CMAKE_CURRENT_LIST_DIR}/compare_scene.cpp)
umbrick_flags(umbrick_random_pictures)
target_include_directories(umbrick_random_pictures PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(umbrick_random_pictures PRIVATE umbrick)
if(NOT UMBRICK_SANITIZE)
  umbrick_reuse_openvdb(umbrick_random_pictures ${CMAKE_CURRENT_LIST_DIR}/random_scene.cpp ${CMAKE_CURRENT_LIST_DIR}/compare_scene.cpp)
endif()

umbrick_tests(fuzz pictures/random_pictures_gl_test.cpp)
target_link_libraries(umbrick_fuzz_tests PRIVATE umbrick_random_pictures)

add_executable(umbrick_fuzz_pictures EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/main.cpp support/test_grids.cpp)
umbrick_flags(umbrick_fuzz_pictures)
target_include_directories(umbrick_fuzz_pictures PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(umbrick_fuzz_pictures PRIVATE umbrick umbrick_random_pictures nlohmann_json::nlohmann_json)
