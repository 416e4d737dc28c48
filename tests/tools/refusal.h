// Tests what the program does with a command that it does not carry out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tools/program.h"

namespace umbrick {

/// Runs the program and expects a complaint of one line that holds `message`, and no file that was not there before.
inline ProgramResult expectRefusal(const TemporaryFolder& folder, const std::string& arguments, int status,
                                   const std::string& message) {
  CAPTURE(arguments);
  const std::size_t before = filesIn(folder);
  const ProgramResult result = runProgram(folder, arguments);
  CHECK(result.status == status);
  CHECK_THAT(result.err, Catch::Contains(message));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(filesIn(folder) == before);
  return result;
}

}  // namespace umbrick
