// SPDX-License-Identifier: Apache-2.0
#include "convert_isosurface.h"

#include <cstdio>
#include <iostream>

#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick::tools {

IsosurfaceReport replaceByIsosurface(const std::filesystem::path& input, const IsosurfaceOptions& options,
                                     BuiltGrid& built) try {
  const Isosurface surface = makeIsosurface({built.grid, built.grid->getName()}, options);
  built.grid = surface.grid;
  built.report.activeVoxels = surface.report.activeVoxels;
  return surface.report;
} catch (const InvalidArgument& error) {
  throw InvalidArgument(input.string() + ": " + error.what());
}

void printIsosurface(const std::string& label, float value, const IsosurfaceReport& report) {
  using Count = unsigned long long;
  char line[256];
  std::snprintf(line, sizeof line, "at %.9g, voxels %.9g apart; %llu active, %llu leaves", double(value),
                report.voxelSize, Count(report.activeVoxels), Count(report.leaves));
  std::cout << "grid \"" << label << "\"\n  level set       " << line << '\n';
  std::snprintf(line, sizeof line, "%.3g voxels at most, RMS %.3g, where %llu edges of the volume cross the value",
                report.maxError, report.rmsError, Count(report.crossings));
  std::cout << "  off by          " << line << '\n';
}

}  // namespace umbrick::tools
