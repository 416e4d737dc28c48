// Runs gnuplot, which draws the plots.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

namespace umbrick::tools {

/// Returns name and version: "gnuplot 5.4 patchlevel 4". @throw IoError  gnuplot cannot be run, or draws no SVG
std::string gnuplotVersion();

/// Runs a script in its folder. @throw IoError  names the script and the last line that gnuplot printed
void runGnuplot(const std::filesystem::path& script);

}  // namespace umbrick::tools
