# Installs the libraries with its headers and a CMake package:
#   find_package(umbrick REQUIRED)
#   target_link_libraries(app PRIVATE umbrick::render)   or umbrick::volume, umbrick::study, umbrick::umbrick: all
# Each part is a component, of which packages are made (tools/debian/packages.cmake): program, library, development, python.
# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/umbrick)

install(TARGETS umbrick umbrick_volume umbrick_render umbrick_study EXPORT umbrickTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY include/umbrick DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT umbrickTargets NAMESPACE umbrick:: DESTINATION ${package_dir} COMPONENT development)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/umbrickConfigVersion.cmake COMPATIBILITY SameMinorVersion)
if(BUILD_SHARED_LIBS)
  set(UMBRICK_IS_SHARED TRUE)
else()
  set(UMBRICK_IS_SHARED FALSE)
endif()
configure_file(src/umbrickConfig.cmake.in ${PROJECT_BINARY_DIR}/umbrickConfig.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/umbrickConfig.cmake ${PROJECT_BINARY_DIR}/umbrickConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)
# Where packages put it is the place of a file called copyright.
if(NOT UMBRICK_DEBIAN_PACKAGES)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)
endif()
