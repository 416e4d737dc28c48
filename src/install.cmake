# Installs the libraries with its headers and a CMake package:
#   find_package(umbrick REQUIRED)
#   target_link_libraries(app PRIVATE umbrick::render)   or umbrick::volume, umbrick::study, umbrick::umbrick: all
# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/umbrick)

install(TARGETS umbrick umbrick_volume umbrick_render umbrick_study EXPORT umbrickTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/umbrick DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT umbrickTargets NAMESPACE umbrick:: DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/umbrickConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(src/umbrickConfig.cmake.in ${PROJECT_BINARY_DIR}/umbrickConfig.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/umbrickConfig.cmake ${PROJECT_BINARY_DIR}/umbrickConfigVersion.cmake
        DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
