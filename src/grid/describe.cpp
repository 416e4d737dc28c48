// What a grid holds and what was lost on the way, for the report and for the file.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include "grid/sparse_rule.h"

namespace umbrick {
namespace {

// The errors of conversions one after the other are bounded by their sum, since both norms obey the
// triangle inequality.
template <class Value>
void addTo(openvdb::FloatGrid& grid, const char* key, Value value) {
  using Metadata = openvdb::TypedMetadata<Value>;
  if (const auto before = grid.getMetadata<Metadata>(key)) value += before->value();
  grid.removeMeta(key);
  if (value > 0) grid.insertMeta(key, Metadata(value));
}

}  // namespace

std::string storageText(const BuildOptions& options) {
  std::ostringstream text;
  text.precision(9);
  text << (options.half ? "half" : "float");
  if (options.step > 0) text << ", steps of " << options.step;
  return text.str();
}

void describe(openvdb::FloatGrid& grid, const SparseTally& tally, const BuildOptions& options, BuildReport& report) {
  const openvdb::FloatTree& tree = grid.tree();
  report.activeVoxels = tree.activeVoxelCount();
  report.activeTiles = tree.activeTileCount();
  report.leaves = tree.leafCount();
  LossSum tolerance = tally.leftOut, active = tally.rounded;
  tolerance.add(tally.merged);
  active.add(tally.merged);
  report.tolerance = {tolerance.max, rootMean(tolerance.squares, report.voxels)};
  report.rounding = {tally.rounded.max, rootMean(tally.rounded.squares, report.voxels)};
  report.maxError = std::max(tolerance.max, tally.rounded.max);
  report.rmsError = rootMean(tolerance.squares + tally.rounded.squares, report.voxels);
  report.activeRmsError = rootMean(active.squares, report.activeVoxels);
  report.storage = storageText(options);
  report.clippedVoxels = tally.clipped;
  report.maxClipChange = tally.maxClipChange;
  report.nonFinite = tally.nonFinite;

  addTo(grid, "error_max", report.maxError + report.conversionError);
  addTo(grid, "error_rms", report.rmsError);
  addTo(grid, "error_max_tolerance", report.tolerance.max);
  addTo(grid, "error_rms_tolerance", report.tolerance.rms);
  addTo(grid, "error_max_rounding", report.rounding.max);
  addTo(grid, "error_rms_rounding", report.rounding.rms);
  addTo(grid, "error_max_to_float", report.conversionError);
  addTo(grid, "clipped_voxels", static_cast<std::int64_t>(report.clippedVoxels));
  addTo(grid, "clipped_max_change", report.maxClipChange);
  grid.removeMeta("storage");
  grid.insertMeta("storage", openvdb::StringMetadata(report.storage));
}

void addQuantising(BuildReport& report, const QuantiseError& error, bool activeOnly) {
  report.quantising = {error.max, rootMean(activeOnly ? error.activeSquares : error.squares, report.voxels)};
  report.maxError += report.quantising.max;
  report.rmsError += report.quantising.rms;
  report.activeRmsError += rootMean(error.activeSquares, report.activeVoxels);
}

}  // namespace umbrick
