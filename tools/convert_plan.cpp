// SPDX-License-Identifier: Apache-2.0
#include "convert_report.h"

#include <cstdio>
#include <iostream>
#include <string>

#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

std::string count(const Estimate& estimate) {
  char text[96];
  if (estimate.uncertainty > 0)
    std::snprintf(text, sizeof text, "%.0f +- %.0f", estimate.value, estimate.uncertainty);
  else
    std::snprintf(text, sizeof text, "%.0f", estimate.value);
  return text;
}

std::string megabytes(const Estimate& estimate) {
  char text[96];
  if (estimate.uncertainty > 0)
    std::snprintf(text, sizeof text, "%.4g MB +- %.2g MB", estimate.value / 1e6, estimate.uncertainty / 1e6);
  else
    std::snprintf(text, sizeof text, "%.4g MB", estimate.value / 1e6);
  return text;
}

const char* nameOf(VdbCodec codec) {
  return codec == VdbCodec::zip ? "zip" : codec == VdbCodec::none ? "not packed" : "blosc";
}

}  // namespace

void printPlan(const VolumePlan& volume, VdbCodec codec) {
  const GridPlan& plan = volume.grid;
  if (volume.background) printBackground(*volume.background);
  char share[64];
  std::snprintf(share, sizeof share, "%.3g %%", 100 * double(plan.voxelsRead) / double(plan.voxels));
  std::cout << "plan of " << printable(volume.input.string()) << ", from " << share
            << " of its voxels: " << plan.layersRead << " of " << plan.layers << " layers of 8 slices\n";
  std::snprintf(share, sizeof share, " (%.2f %%)", 100 * plan.activeVoxels.value / double(plan.voxels));
  std::cout << "  active voxels   " << count(plan.activeVoxels) << " of " << plan.voxels << share << '\n'
            << "  leaves          " << count(plan.leaves) << '\n'
            << "  stored as       " << plan.storage << '\n'
            << "  grid in memory  " << megabytes(plan.gridBytes) << '\n'
            << "  .vdb on disk    " << megabytes(plan.fileBytes) << ", " << nameOf(codec) << '\n'
            << "  converting      " << megabytes(plan.peakBytes)
            << " of memory, besides some 60 MB of the program's own\n";
}

}  // namespace umbrick::tools
