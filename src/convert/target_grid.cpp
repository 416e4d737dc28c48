// SPDX-License-Identifier: Apache-2.0
#include "convert/target_grid.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "umbrick/core/patient_space.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/change_values.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/grid/orientation.h"

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

glm::dmat3 bodyAxes(Axis up, Axis front, bool mirrored) {
  const glm::dvec3 u = axisDirection(up), f = axisDirection(front);
  return {glm::cross(u, f) * (mirrored ? -1.0 : 1.0), f, u};
}

double metresOf(const std::string& unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  if (unit == "um") return 1e-6;
  if (unit == "nm") return 1e-9;
  if (unit == "pm") return 1e-12;
  return 0;
}

Orientation orientationFor(const FloatGrid& grid, const OutputOptions& output, bool foreign) {
  Orientation found = orientationOf(viewOf(grid), foreign);
  if (output.up == Axis::automatic) return found;
  if (found.anatomy && output.up == found.up) return found;
  return {.up = output.up, .front = usualFront(output.up), .reason = "as was asked for"};
}

// The letters of a patient's space whose axes are turned.
std::string turnedSpace(const std::string& space, const glm::dmat3& turn) {
  const std::optional<PatientAxes> axes = patientAxes(space);
  if (!axes) return space;
  const glm::dvec3 body[3]{turn * axes->left, turn * axes->posterior, turn * axes->superior};
  const char* letters[3]{"LR", "PA", "SI"};
  std::string turned(3, ' ');
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (body[i][axis] != 0) turned[static_cast<std::size_t>(axis)] = letters[i][body[i][axis] > 0 ? 0 : 1];
  return turned;
}

// Places a grid in the target's world. @return by what lengths are multiplied
double place(const TargetTraits& target, const Orientation& orientation, FloatGrid& grid,
             std::vector<std::string>& notes) {
  const World world = worldOf(grid);
  glm::dmat3 turn = bodyAxes(target.up, usualFront(target.up), false) *
                    glm::transpose(bodyAxes(orientation.up, orientation.front, orientation.mirrored));
  std::string line = "for " + std::string(target.name) + ": " + std::string(nameOf(kAxes, orientation.up)) + " (" +
                     orientation.reason + ") becomes " + std::string(nameOf(kAxes, target.up)) + ", which is up";
  if (target.leftHanded) {
    turn = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, 1) * turn;
    line += ", and y is mirrored, since its world is left-handed";
  }
  const double metres = metresOf(world.lengthUnit);
  double scale = metres > 0 ? metres / target.metresPerUnit : 1;
  if (scale < 1) scale = 1 / std::round(1 / scale);  // units are powers of ten apart
  const glm::dmat3 voxel = turn * glm::dmat3(affineMatrix(grid.transform()));
  constexpr double kLeastVoxel = 4e-15;  // OpenVDB takes smaller ones for nothing
  int smaller = 0;
  for (; std::abs(glm::determinant(voxel)) * scale * scale * scale < kLeastVoxel && smaller < 12; smaller += 3)
    scale *= 1000;
  const std::string unit = (smaller > 0 ? "1e-" + std::to_string(smaller) + ' ' : "") + std::string(target.unit);
  line += metres > 0 ? "; lengths are in " + unit
                     : "; the file states no unit of length, so that its numbers are taken for " + unit;
  if (smaller > 0) line += ", since OpenVDB holds no voxels that small in " + std::string(target.unit);
  notes.push_back(line);
  const glm::dmat4 change = glm::scale(glm::dmat4(1), glm::dvec3(scale)) * glm::dmat4(turn);
  grid.transform().postMult(rowMatrix(change));
  if (!world.space.empty()) grid.insertMeta("space", StringMetadata(turnedSpace(world.space, turn)));
  grid.insertMeta("length_unit", StringMetadata(unit));
  grid.insertMeta("made_for", StringMetadata(std::string(target.name)));
  return scale;
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
  using Leaves = openvdb::tree::LeafManager<const FloatTree>;
  const auto lost = [&](float value) {
    return std::abs(double(value) - double(original(mapped(value, map, half), map)));
  };
  const Leaves leaves(tree);
  QuantiseError error = tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), QuantiseError{},
      [&](const auto& range, QuantiseError sum) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < FloatTree::LeafNodeType::SIZE; ++i) {
            const double one = lost(leaf->getValue(i));
            sum.max = std::max(sum.max, one);
            sum.squares += one * one;
            if (leaf->isValueOn(i)) sum.activeSquares += one * one;
          }
        return sum;
      },
      [](QuantiseError a, const QuantiseError& b) {
        return QuantiseError{std::max(a.max, b.max), a.squares + b.squares, a.activeSquares + b.activeSquares};
      });
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const double one = lost(*tile), squares = one * one * static_cast<double>(tile.getVoxelCount());
    error = {std::max(error.max, one), error.squares + squares, error.activeSquares + squares};
  }
  return error;
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

// Says where the target has a limit, and which spacing keeps it.
void tellLimits(const TargetTraits& target, const FloatGrid& grid, double scale, std::vector<std::string>& notes) {
  const openvdb::Coord dims = grid.evalActiveVoxelDim();
  const int longest = std::max({dims.x(), dims.y(), dims.z()});
  const double voxels =
      target.dense ? double(dims.x()) * double(dims.y()) * double(dims.z()) : 512.0 * double(grid.tree().leafCount());
  const double bytes = 2 * voxels;
  double factor = 1;
  if (target.longest > 0) factor = std::max(factor, double(longest) / double(target.longest));
  if (target.mostBytes > 0) factor = std::max(factor, std::cbrt(bytes / double(target.mostBytes)));
  if (factor <= 1) return;
  const openvdb::Vec3d size = grid.voxelSize() / scale;
  const auto spacing = [&](int axis) { return shortNumber(std::ceil(factor * size[axis] * 1e3) / 1e3, 6); };
  notes.push_back(std::string(target.name) + " takes volumes of up to " + std::to_string(target.longest) +
                  " voxels along an axis and " + std::to_string(target.mostBytes >> 30) + " GiB, found " +
                  std::to_string(dims.x()) + " x " + std::to_string(dims.y()) + " x " + std::to_string(dims.z()) +
                  ", " + shortNumber(bytes / double(1 << 30), 3) + " GiB; spacing " + spacing(0) + ' ' + spacing(1) +
                  ' ' + spacing(2) + " by resampling keeps it, or parts by cropping");
}

void tellShear(const TargetTraits& target, const FloatGrid& grid, std::vector<std::string>& notes) {
  if (!target.leftHanded) return;
  const glm::dmat3 m(affineMatrix(grid.transform()));
  const auto slant = [&](int a, int b) {
    return std::abs(glm::dot(m[a], m[b])) > 1e-6 * glm::length(m[a]) * glm::length(m[b]);
  };
  if (slant(0, 1) || slant(1, 2) || slant(0, 2))
    notes.push_back(std::string(target.name) +
                    " has no sheared transforms, and this one is sheared: it will look upright there; resampling "
                    "does not help, since voxels stay along the axes of the file");
}

// @param maxError  what may still be lost; half floats are not taken where they would lose more
TargetChange change(const OutputOptions& output, bool foreign, std::optional<double> maxError, FloatGrid& grid) {
  const TargetTraits& target = traitsOf(*output.target);
  TargetChange change;
  const double scale = place(target, orientationFor(grid, output, foreign), grid, change.notes);
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    change.map = ValueMap{0, 1 / scale};  // distances are lengths
    change.error = errorOf(grid.tree(), *change.map, false);
    changeValues(grid.tree(), [&](float distance) { return mapped(distance, *change.map, false); });
  } else if (target.unitValues) {
    mapValues(maxError, grid, change);
  }
  tellLimits(target, grid, scale, change.notes);
  tellShear(target, grid, change.notes);
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
