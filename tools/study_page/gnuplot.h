// The program that draws the plots.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

namespace umbrick::tools {

/// "gnuplot 5.4 patchlevel 4". @throw IoError  it cannot be run, or draws no SVG
std::string gnuplotVersion();

/// Runs a script in its folder. @throw IoError  names the script and the last line that gnuplot said
void runGnuplot(const std::filesystem::path& script);

}  // namespace umbrick::tools
