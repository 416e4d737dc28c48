// SPDX-License-Identifier: Apache-2.0
#include "convert/target_grid.h"

#include <algorithm>
#include <cmath>

#include "convert/target_place.h"
#include "convert/value_loss.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/change_values.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {
namespace {

using openvdb::FloatGrid;
using openvdb::FloatTree;
using openvdb::StringMetadata;

// What was done to a grid.
struct TargetChange {
  std::optional<ValueMap> map;
  bool half = false;    // values are saved as half floats, which they were not before
  QuantiseError error;  // of mapping and of half floats, grid units before
  std::vector<std::string> notes;
};

// Shares a grid without owning it.
ScalarGrid viewOf(const FloatGrid& grid) {
  return {std::shared_ptr<const FloatGrid>(std::shared_ptr<void>(), &grid), grid.getName()};
}

float largestActive(const FloatTree& tree) {
  float largest = tree.background();
  for (auto value = tree.cbeginValueOn(); value; ++value) largest = std::max(largest, *value);
  return largest;
}

float mapped(float value, const ValueMap& map, bool half) {
  const auto share = static_cast<float>((static_cast<double>(value) - map.low) / (map.high - map.low));
  return half ? static_cast<float>(openvdb::math::half(share)) : share;
}

float original(float stored, const ValueMap& map) {
  return static_cast<float>(map.low + static_cast<double>(stored) * (map.high - map.low));
}

QuantiseError errorOf(const FloatTree& tree, const ValueMap& map, bool half) {
  return lossOf(tree, [&](float value) {
    const double lost = std::abs(double(value) - double(original(mapped(value, map, half), map)));
    return ValueLoss{lost, lost * lost};
  });
}

void mapValues(std::optional<double> maxError, FloatGrid& grid, TargetChange& change) {
  const ValueMap map{grid.background(), largestActive(grid.tree())};
  if (!(map.high > map.low)) {
    change.notes.push_back("its values are not mapped to 0..1, since none lies above the background");
    return;
  }
  bool half = true;
  change.error = errorOf(grid.tree(), map, half);
  if (maxError && change.error.max > *maxError) change.error = errorOf(grid.tree(), map, half = false);
  changeValues(grid.tree(), [&](float value) { return mapped(value, map, half); });
  grid.setSaveFloatAsHalf(half);
  grid.insertMeta("value_low", openvdb::DoubleMetadata(map.low));
  grid.insertMeta("value_high", openvdb::DoubleMetadata(map.high));
  if (const std::string unit = viewOf(grid).metadata("value_unit"); !unit.empty()) {
    grid.insertMeta("value_range_unit", StringMetadata(unit));
    grid.removeMeta("value_unit");
  }
  change.map = map;
  change.half = half;
  change.notes.push_back("values from " + shortNumber(map.low, 6) + " to " + shortNumber(map.high, 6) +
                         " become 0 to 1, as " + (half ? "half floats" : "floats") +
                         "; value_low and value_high in the metadata of the grid bring them back");
}

// @param maxError  what may still be lost; half floats are not taken where they would lose more
TargetChange change(const OutputOptions& output, bool foreign, std::optional<double> maxError, FloatGrid& grid) {
  const TargetTraits& target = traitsOf(*output.target);
  TargetChange change;
  const double scale = placeFor(output, foreign, grid, change.notes).scale;
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    change.map = ValueMap{0, 1 / scale};  // distances are lengths
    change.error = errorOf(grid.tree(), *change.map, false);
    changeValues(grid.tree(), [&](float distance) { return mapped(distance, *change.map, false); });
  } else if (target.unitValues) {
    mapValues(maxError, grid, change);
  }
  tellLimits(target, grid, scale, /*resamples=*/true, change.notes);
  return change;
}

}  // namespace

bool mapsValues(const ConvertOptions& options) {
  return options.output.target && traitsOf(*options.output.target).unitValues && !options.isosurface;
}

void leaveOutBelow(float background, BuildOptions& build) {
  build.clipBelow = std::max(build.clipBelow.value_or(background), background);
}

std::optional<ValueMap> prepareFor(const ConvertOptions& options, bool foreign, FloatGrid& grid,
                                   ConvertedGrid& report) {
  std::optional<double> left;
  if (options.build.maxError) left = *options.build.maxError - report.build.maxError;
  const TargetChange made = change(options.output, foreign, left, grid);
  if (made.half) report.build.storage = "half";
  if (!options.isosurface) addQuantising(report.build, made.error, /*activeOnly=*/foreign);
  report.notes.insert(report.notes.end(), made.notes.begin(), made.notes.end());
  return made.map;
}

void prepareLabel(const ConvertOptions& options, FloatGrid& grid, ConvertedGrid& report) {
  const double scale = placeFor(options.output, /*foreign=*/false, grid, report.notes).scale;
  const auto half = [](float share) { return static_cast<float>(openvdb::math::half(share)); };
  const QuantiseError error = lossOf(grid.tree(), [&](float share) {
    const double lost = std::abs(double(share) - double(half(share)));
    return ValueLoss{lost, lost * lost};
  });
  if (error.max > 0) changeValues(grid.tree(), half);
  grid.setSaveFloatAsHalf(true);
  report.build.storage = "half";
  addQuantising(report.build, error, /*activeOnly=*/false);
  tellLimits(traitsOf(*options.output.target), grid, scale, /*resamples=*/false, report.notes);
}

std::string nameFor(Target target, const std::vector<FloatGrid*>& grids) {
  for (const FloatGrid* grid : grids)
    if (grid->getName() == "density") return {};
  for (FloatGrid* grid : grids) {
    const std::string name = grid->getName();
    const bool known = name == "temperature" || name == "heat" || name == "flame" || name == "fuel";
    if (known || grid->getGridClass() == openvdb::GRID_LEVEL_SET) continue;
    grid->setName("density");
    return "grid \"" + name + "\" is called density, where " + std::string(traitsOf(target).name) + " looks for it";
  }
  return {};
}

FloatGrid::ConstPtr unmapped(const FloatGrid::ConstPtr& grid, const std::optional<ValueMap>& map) {
  if (!map) return grid;
  const auto copy = grid->deepCopy();
  changeValues(copy->tree(), [&](float stored) { return original(stored, *map); });
  return copy;
}

}  // namespace umbrick
