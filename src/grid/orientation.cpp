// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/orientation.h"

#include <glm/geometric.hpp>
#include <optional>

#include "umbrick/core/patient_space.h"

namespace umbrick {
namespace {

Axis axisAlong(const glm::dvec3& direction) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::minusX, Axis::minusY, Axis::minusZ})
    if (axisDirection(axis) == direction) return axis;
  return Axis::automatic;
}

std::optional<Orientation> anatomyOf(const std::string& space) {
  const std::optional<PatientAxes> axes = patientAxes(space);
  if (!axes) return std::nullopt;
  Orientation found{.up = axisAlong(axes->superior),
                    .front = axisAlong(-axes->posterior),
                    .anatomy = true,
                    .reason = "the file's " + space};
  found.mirrored = glm::dot(glm::cross(axes->superior, -axes->posterior), axes->left) < 0;
  return found;
}

}  // namespace

Orientation orientationOf(const ScalarGrid& grid, bool foreign, const std::string& creator) {
  if (const auto anatomy = anatomyOf(grid.metadata("space"))) return *anatomy;
  if (!foreign || !grid.metadata("source_format").empty()) return {.reason = "the usual of scans"};
  if (creator.find("Blender") != std::string::npos) return {.reason = "z is up in Blender"};
  const glm::dvec3 extent = grid.worldBounds().extent();
  constexpr double kClearlyTaller = 1.2;
  if (extent.z > kClearlyTaller * extent.y) return {.reason = "the grid is taller along z than along y"};
  return {.up = Axis::y, .front = usualFront(Axis::y), .reason = "y is up in most files of grids"};
}

}  // namespace umbrick
