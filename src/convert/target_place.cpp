// SPDX-License-Identifier: Apache-2.0
#include "convert/target_place.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "umbrick/core/patient_space.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/grid/orientation.h"

namespace umbrick {
namespace {

using openvdb::FloatGrid;
using openvdb::StringMetadata;

glm::dmat3 bodyAxes(Axis up, Axis front, bool mirrored) {
  const glm::dvec3 u = axisDirection(up), f = axisDirection(front);
  return {glm::cross(u, f) * (mirrored ? -1.0 : 1.0), f, u};
}

// The grid as orientationOf wants it. Of a grid that holds no floats place and metadata are enough, since only foreign
// ones are looked into.
ScalarGrid orientable(const openvdb::GridBase& grid) {
  if (const auto* floats = dynamic_cast<const FloatGrid*>(&grid))
    return {std::shared_ptr<const FloatGrid>(std::shared_ptr<void>(), floats), grid.getName()};
  const auto empty = FloatGrid::create();
  empty->insertMeta(grid);
  empty->setTransform(grid.transform().copy());
  return {empty, grid.getName()};
}

Orientation orientationFor(const openvdb::GridBase& grid, const OutputOptions& output, bool foreign) {
  Orientation found = orientationOf(orientable(grid), foreign);
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

void tellSize(const TargetTraits& target, const openvdb::GridBase& grid, double scale, bool resamples,
              std::vector<std::string>& notes) {
  const openvdb::Coord dims = grid.evalActiveVoxelDim();
  const int longest = std::max({dims.x(), dims.y(), dims.z()});
  const double voxels = target.dense ? double(dims.x()) * double(dims.y()) * double(dims.z())
                                     : 512.0 * double(grid.baseTree().leafCount());
  constexpr double kTexel = 2, kVectorTexel = 8;  // bytes, of 16-bit numbers; three of them take the room of four
  const double bytes = (grid.isType<openvdb::Vec3SGrid>() ? kVectorTexel : kTexel) * voxels;
  double factor = 1;
  if (target.longest > 0) factor = std::max(factor, double(longest) / double(target.longest));
  if (target.mostBytes > 0) factor = std::max(factor, std::cbrt(bytes / double(target.mostBytes)));
  if (factor <= 1) return;
  const openvdb::Vec3d size = grid.voxelSize() / scale;
  const auto spacing = [&](int axis) { return shortNumber(std::ceil(factor * size[axis] * 1e3) / 1e3, 6); };
  notes.push_back(std::string(target.name) + " takes volumes of up to " + std::to_string(target.longest) +
                  " voxels along an axis and " + std::to_string(target.mostBytes >> 30) + " GiB, found " +
                  std::to_string(dims.x()) + " x " + std::to_string(dims.y()) + " x " + std::to_string(dims.z()) +
                  ", " + shortNumber(bytes / double(1 << 30), 3) + " GiB; " +
                  (resamples ? "spacing " + spacing(0) + ' ' + spacing(1) + ' ' + spacing(2) +
                                   " by resampling keeps it, or parts by cropping"
                             : "parts by cropping keep it"));
}

void tellShear(const TargetTraits& target, const openvdb::GridBase& grid, std::vector<std::string>& notes) {
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

}  // namespace

double metresOf(const std::string& unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  if (unit == "um") return 1e-6;
  if (unit == "nm") return 1e-9;
  if (unit == "pm") return 1e-12;
  return 0;
}

TargetPlace placeFor(const OutputOptions& output, bool foreign, openvdb::GridBase& grid,
                     std::vector<std::string>& notes) {
  const TargetTraits& target = traitsOf(*output.target);
  const Orientation orientation = orientationFor(grid, output, foreign);
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
  return {turn, scale, target.metresPerUnit * std::pow(10, -smaller), unit};
}

void tellLimits(const TargetTraits& target, const openvdb::GridBase& grid, double scale, bool resamples,
                std::vector<std::string>& notes) {
  tellSize(target, grid, scale, resamples, notes);
  tellShear(target, grid, notes);
}

}  // namespace umbrick
