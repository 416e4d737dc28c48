# Installs the build in BUILD below WORK, then configures, builds and runs the user's project in SOURCE, and the example of
# the README of the checkout TOP.
# SPDX-License-Identifier: Apache-2.0
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${output}")
  endif()
endfunction()
# The one block of C++.
file(READ ${TOP}/README.md page)
string(FIND "${page}" "```cpp\n" begin)
string(SUBSTRING "${page}" ${begin} -1 page)
string(FIND "${page}" "\n```\n" end)
string(SUBSTRING "${page}" 7 ${end} example)
string(REGEX REPLACE "\n```.*" "\n" example "${example}")
file(WRITE ${WORK}/example.cpp "${example}")

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release
    -DUMBRICK_SANITIZE=${SANITIZE} -DEXAMPLE=${WORK}/example.cpp)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/umbrick_user)
run(${WORK}/prefix/bin/umbrick --version)

# What reads files and draws nothing links no OpenGL; what renders .vdb files links no reader of DICOM or HDF5. Where many
# files are compiled as one, who needs one of them gets all.
execute_process(COMMAND readelf -d ${WORK}/build/umbrick_user OUTPUT_VARIABLE libraries)
if(NOT SANITIZE AND NOT UNITY AND libraries MATCHES "NEEDED[^\n]*(gdcm|hdf5|OSMesa|libGL|libEGL)[^\n]*")
  message(FATAL_ERROR "a program that reads a .vdb file needs ${CMAKE_MATCH_0}")
endif()

# The example reads the bundled volume of the checkout and writes beside itself.
file(CREATE_LINK ${TOP}/assets ${WORK}/assets SYMBOLIC)
execute_process(COMMAND ${WORK}/build/umbrick_example WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status
                OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(output MATCHES "no OpenGL context")
  message(STATUS "SKIPPED: ${output}")
elseif(NOT status EQUAL 0)
  message(FATAL_ERROR "the example of the README fails: ${output}")
else()
  foreach(picture skin bone)
    file(SIZE ${WORK}/${picture}.png bytes)
    if(bytes LESS 20000)
      message(FATAL_ERROR "the example of the README made ${picture}.png of ${bytes} bytes, too few for a head")
    endif()
  endforeach()
endif()
