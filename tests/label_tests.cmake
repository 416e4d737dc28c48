# Writes the labels of a program's tests where CTest reads them, after the list of tests that Catch's CMake module writes:
#   cmake -DPROGRAM=... -DPREFIX=... -Dslow=SPEC -Dgl=SPEC -Dkill=SPEC -Dfuzz=SPEC -DOUTPUT=... -P label_tests.cmake
# A SPEC says in Catch's words which tests have the label: [tag], or [#file] for the tests of file.cpp. Catch's module can
# set labels too, but only on all that one call lists: each combination of labels would be a list of its own.
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
set(all "")
foreach(label slow gl kill fuzz)
  set(tests_${label} "")
  if(${label})
    execute_process(COMMAND ${PROGRAM} --filenames-as-tags ${${label}} --list-test-names-only
                    OUTPUT_VARIABLE names RESULT_VARIABLE status)
    if(NOT status MATCHES "^[0-9]+$")  # the number of tests, where all is well
      message(FATAL_ERROR "${PROGRAM} cannot list its tests: ${status}\n${names}")
    endif()
    string(REGEX REPLACE "\n+" ";" tests_${label} "${names}")
    list(APPEND all ${tests_${label}})
  endif()
endforeach()
list(REMOVE_DUPLICATES all)

set(script "")
foreach(test ${all})
  set(labels "")
  foreach(label slow gl kill fuzz)
    if(test IN_LIST tests_${label})
      list(APPEND labels ${label})
    endif()
  endforeach()
  string(APPEND script "set_tests_properties([==[${PREFIX}${test}]==] PROPERTIES LABELS \"${labels}\")\n")
endforeach()
file(WRITE ${OUTPUT} "${script}")
