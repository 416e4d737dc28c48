// What umbrick convert prints about a grid that it built.
#pragma once
#include <string>

#include "umbrick/grid/build_grid.h"

namespace umbrick::tools {

/// On stdout.
/// @param dense  the source was a dense volume, not a grid
void printReport(const std::string& label, const BuildReport& report, bool dense);

}  // namespace umbrick::tools
