// The example of a job for a cluster fits the program.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <regex>
#include <string>

#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("The job script for Slurm is a script, and names options that the program has", "[dist]") {
  const TemporaryFolder folder;
  const std::filesystem::path path = std::filesystem::path(UMBRICK_EXAMPLES) / "render_sequence.slurm";
  CHECK(runShell(folder, "bash -n '" + path.string() + "'").err.empty());
  const std::string script = readBytes(path), help = runProgram(folder, "render --help").out;
  const std::size_t begin = script.find("umbrick render");
  REQUIRE(begin != script.npos);
  const std::string command = script.substr(begin, script.find(" &", begin) - begin);
  const std::regex option("(^|\\s)(--?[a-z][a-z-]*)");
  int options = 0;
  for (std::sregex_iterator found(command.begin(), command.end(), option), end; found != end; ++found, ++options)
    CHECK_THAT(help, Contains("  " + found->str(2)) || Contains("," + found->str(2)));
  CHECK(options >= 4);
}
