// Reads what the program says of the grids of a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"

namespace umbrick {

inline nlohmann::json gridsOf(const TemporaryFolder& folder, const std::string& file) {
  return nlohmann::json::parse(runProgram(folder, "info --json " + file).out).at("grids");
}

}  // namespace umbrick
