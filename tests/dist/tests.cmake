# SPDX-License-Identifier: Apache-2.0
if(UMBRICK_TOOLS)
  umbrick_tests(dist job_script_test.cpp mpi_ranks_test.cpp picture_bytes_test.cpp work_ledger_test.cpp)
  target_link_libraries(umbrick_dist_tests PRIVATE umbrick_dist nlohmann_json::nlohmann_json)
  target_compile_definitions(umbrick_dist_tests PRIVATE UMBRICK_MPI_MISSING="${UMBRICK_MPI_MISSING}"
                             UMBRICK_EXAMPLES="${PROJECT_SOURCE_DIR}/tools/examples")
  add_dependencies(umbrick_dist_tests umbrick_tool)
endif()
