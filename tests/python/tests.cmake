# The tests of the Python module: pytest, one test of CTest for each file.
# SPDX-License-Identifier: Apache-2.0
foreach(name volumes pictures jobs examples)
  if(TARGET umbrick_python)
    add_test(NAME "python: ${name}"
             COMMAND ${Python_EXECUTABLE} -B -m pytest -q -p no:cacheprovider ${CMAKE_CURRENT_LIST_DIR}/test_${name}.py)
    set_tests_properties("python: ${name}" PROPERTIES
                         ENVIRONMENT "PYTHONPATH=$<TARGET_FILE_DIR:umbrick_python>/..;UMBRICK_ASSETS=${PROJECT_SOURCE_DIR}/assets;UMBRICK_EXAMPLES=${PROJECT_SOURCE_DIR}/tools/examples;UMBRICK_PROGRAM=$<$<TARGET_EXISTS:umbrick_tool>:$<TARGET_FILE:umbrick_tool>>;PYTHONDONTWRITEBYTECODE=1"
                         SKIP_REGULAR_EXPRESSION "No module named pytest;No module named numpy")
  else()
    add_test(NAME "python: ${name}" COMMAND ${CMAKE_COMMAND} -E echo "SKIPPED: the Python module is not built (${UMBRICK_PYTHON_MISSING})")
    set_tests_properties("python: ${name}" PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED:")
  endif()
endforeach()
