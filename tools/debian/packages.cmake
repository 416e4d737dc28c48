# The Debian packages that CPack makes of the installed components (src/install.cmake). tools/package is the command for it.
# SPDX-License-Identifier: Apache-2.0
if(NOT BUILD_SHARED_LIBS)
  message(FATAL_ERROR "UMBRICK_DEBIAN_PACKAGES needs BUILD_SHARED_LIBS=ON: the packages share the library")
endif()
set(UMBRICK_PACKAGE_MAINTAINER "Umbrick maintainers <maintainers@umbrick.invalid>" CACHE STRING "Who answers for the packages")
set(debian_version ${PROJECT_VERSION}-1)
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(packages umbrick libumbrick${soversion} libumbrick-dev)
set(components program library development)
if(TARGET umbrick_python)
  list(APPEND packages python3-umbrick)
  list(APPEND components python)
  # A module is of the version of Python that it is compiled for.
  execute_process(COMMAND python3 -c "import sys; a, b = sys.version_info[:2]; print(f'python3 (>= {a}.{b}), python3 (<< {a}.{b + 1})', end='')"
                  OUTPUT_VARIABLE python_versions COMMAND_ERROR_IS_FATAL ANY)
endif()

# --- what Debian asks of each package: its licence and what has changed ---
# A text as a field of a file of fields: a blank in front of each line, and a dot for an empty one.
function(read_as_field file result)
  file(READ ${file} text)
  string(STRIP "${text}" text)
  string(REGEX REPLACE "[ \t\r]+\n" "\n" text "${text}")
  foreach(twice 1 2)
    string(REPLACE "\n\n" "\n.\n" text "${text}")
  endforeach()
  string(REPLACE "\n" "\n " text "${text}")
  set(${result} " ${text}" PARENT_SCOPE)
endfunction()
read_as_field(${PROJECT_SOURCE_DIR}/assets/LICENSES/VTKData-BSD3.txt VTK_DATA_LICENCE)
read_as_field(${PROJECT_SOURCE_DIR}/assets/LICENSES/OpenUSD-TOST1.0.txt SMOKE_LICENCE)
read_as_field(/usr/share/doc/ttf-bitstream-vera/copyright VERA_LICENCE)
configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright.in ${PROJECT_BINARY_DIR}/debian/copyright @ONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${PROJECT_BINARY_DIR}/debian/changelog @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/debian/changelog COMMAND_ERROR_IS_FATAL ANY)
foreach(package component IN ZIP_LISTS packages components)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package})
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${folder} RENAME changelog.Debian.gz COMPONENT ${component})
endforeach()
# Volumes to begin with, as the manual's examples and the walks name them.
install(FILES ${PROJECT_SOURCE_DIR}/assets/densityAndHeat.vdb ${PROJECT_SOURCE_DIR}/assets/headsq_256x256x94_uint16le.raw.gz
              ${PROJECT_SOURCE_DIR}/assets/README.md
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/umbrick/examples COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/tools/docs/from_scan_to_picture.md
              ${PROJECT_SOURCE_DIR}/tools/docs/simulation_over_time.md ${PROJECT_SOURCE_DIR}/tools/docs/what_accuracy_costs.md
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/umbrick COMPONENT program)

# --- common to all ---
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME umbrick)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${UMBRICK_PACKAGE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Each package gives a summary of its own in the first line of its description.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
# Which packages the binaries need is found by dpkg-shlibdeps; it looks for the project's own libraries in the build.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(same_version "(= ${debian_version})")
set(about "Umbrick converts scans and simulation output to sparse OpenVDB grids, cuts
grids into bricks and renders what the transfer function shows of them: by
rays on the CPU, or by slices and rays on OpenGL, with directional occlusion.
")

# --- umbrick: the program ---
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME umbrick)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "convert, render and check sparse volumes
${about}.
This package has the program umbrick, its manual, completion for bash, zsh and
fish, and two volumes as examples.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libumbrick${soversion} ${same_version}")
# Plots of studies; films; the viewer's page; mpirun.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "ffmpeg, www-browser, openmpi-bin")

# --- libumbrick0.1: the shared library ---
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libumbrick${soversion})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "sparse volumes: shared library
${about}.
This package has the shared library.")
# OpenGL is loaded at run time, so that no tool finds that it is needed: OSMesa draws without a GPU or a display, EGL on
# a GPU where there is one.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libosmesa6")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri")

# The loader's cache is brought up to date once, after all packages of an installation.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/triggers)

# --- libumbrick-dev: headers and the CMake package ---
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libumbrick-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "sparse volumes: headers and CMake package
${about}.
This package has what programs need that use the library: its headers and a
CMake package.")
# What its headers include, and what its CMake package finds. libopenvdb-dev does not bring the boost headers that its own
# include.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libumbrick${soversion} ${same_version}, libopenvdb-dev, libboost-iostreams-dev, libtbb-dev, libglm-dev, libgl-dev")

# --- python3-umbrick: the Python module ---
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-umbrick)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "sparse volumes: Python module
${about}.
This package has the module umbrick of Python 3, which exchanges volumes and
pictures with NumPy.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "libumbrick${soversion} ${same_version}, ${python_versions}, python3-numpy")

include(CPack)
