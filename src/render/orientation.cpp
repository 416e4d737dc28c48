// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/orientation.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

struct View {
  std::string_view name;
  bool anatomy;               // whether only volumes that state their anatomy have it
  double azimuth, elevation;  // quarter turns
};
// What lies on the left in the view of the front of a thing is, of a patient who faces the viewer, the right side.
constexpr View kViews[]{{"front", false, 0, 0},   {"back", false, 2, 0},     {"left", false, -1, 0},
                        {"right", false, 1, 0},   {"top", false, 0, 1},      {"bottom", false, 0, -1},
                        {"anterior", true, 0, 0}, {"posterior", true, 2, 0}, {"left", true, 1, 0},
                        {"right", true, -1, 0},   {"superior", true, 0, 1},  {"inferior", true, 0, -1}};

}  // namespace

Orbit settledOrbit(const Orbit& orbit, const Orientation& orientation) {
  Orbit settled = orbit;
  const bool stated = orbit.up != Axis::automatic && orbit.up != orientation.up;
  if (settled.up == Axis::automatic) settled.up = orientation.up;
  if (settled.front == Axis::automatic) settled.front = stated ? usualFront(settled.up) : orientation.front;
  if (glm::dot(axisDirection(settled.up), axisDirection(settled.front)) != 0)
    throw InvalidArgument("camera.frontAxis: expected an axis at right angles to the one that is up, " +
                          std::string(nameOf(kAxes, settled.up)) + ", found " +
                          std::string(nameOf(kAxes, settled.front)));
  return settled;
}

Orbit namedView(std::string_view name, Orbit orbit, const Orientation& orientation) {
  const View* found = nullptr;
  std::vector<std::string> names;
  bool known = false;
  for (const View& view : kViews) {
    known = known || view.name == name;
    if (std::find(names.begin(), names.end(), view.name) == names.end() && (!view.anatomy || orientation.anatomy))
      names.emplace_back(view.name);
    // Of a patient the view with anatomy stands behind, and wins.
    if (view.name == name && (!view.anatomy || orientation.anatomy)) found = &view;
  }
  if (!found)
    throw InvalidArgument("view: expected one of " + joined(names) + ", found '" + std::string(name) + "'" +
                          (known ? ", but the volume does not state its anatomy" : ""));
  const double sense = found->anatomy && orientation.mirrored ? -1 : 1;
  orbit.azimuth = sense * found->azimuth * std::numbers::pi / 2;
  orbit.elevation = found->elevation * std::numbers::pi / 2;
  return orbit;
}

std::vector<std::string> viewNames() {
  std::vector<std::string> names;
  for (const View& view : kViews)
    if (std::find(names.begin(), names.end(), view.name) == names.end()) names.emplace_back(view.name);
  return names;
}

}  // namespace umbrick
