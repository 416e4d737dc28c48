// SPDX-License-Identifier: Apache-2.0
#include "scene/light_check.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/checker.h"

namespace umbrick {
namespace {

std::string nameOf(std::size_t number) { return "light.sources[" + std::to_string(number) + "]"; }

// Returns degrees of a computed angle without the last digits, which only come from rounding.
std::string printRounded(double radians) { return print(std::round(radians * 180 / std::numbers::pi * 1e9) / 1e9); }

void check(Checker& checker, const ConeLight& cone, const std::string& field) {
  checker.require(isFinite(cone.axis) && cone.axis != glm::dvec3(0), field, "along the axis " + print(cone.axis),
                  "along three finite numbers that are not all 0");
  checker.require(cone.aperture >= 0 && cone.aperture < std::numbers::pi / 2, field,
                  "a cone of half-angle " + printDegrees(cone.aperture), "of one in [0, 90)");
  checker.requireRadiance(cone.radiance, field + ".radiance");
}

void check(Checker& checker, const ListedLight& light, const std::string& field) {
  checker.require(!light.list.empty(), field + ".list", "empty", "one direction or more");
  for (std::size_t i = 0; i < light.list.size(); ++i) {
    const ListedDirection& listed = light.list[i];
    const std::string at = field + ".list[" + std::to_string(i) + "]";
    checker.requireDirection(listed.direction, at + ".direction");
    checker.require(listed.weight >= 0 && std::isfinite(listed.weight), at + ".weight", print(listed.weight),
                    "0 or more");
    checker.requireRadiance(listed.colour, at + ".colour");
  }
}

void check(Checker& checker, const EnvironmentLight& light, const std::string& field) {
  checker.require(light.image && light.image->width >= 1 && light.image->height >= 1, field + ".file", "not loaded",
                  "a map of 1 x 1 pixels or more");
  checker.requireDirection(light.up, field + ".up");
  checker.requireDirection(light.front, field + ".front");
  if (checker.complaint()) return;
  checker.require(glm::length(glm::cross(glm::normalize(light.up), glm::normalize(light.front))) > 1e-9,
                  field + ".front", print(light.front), "across up, which is " + print(light.up));
  checker.require(light.scale >= 0 && std::isfinite(light.scale), field + ".scale", print(light.scale), "0 or more");
}

std::string ending(LightFrame frame) { return frame == LightFrame::world ? " as the camera stands" : ""; }

void checkFront(Checker& checker, const ConeLight& cone, LightFrame frame, const std::string& field,
                const glm::dvec3& viewer) {
  const double tilt = std::atan2(glm::length(glm::cross(cone.axis, viewer)), glm::dot(cone.axis, viewer));
  if (tilt + cone.aperture < std::numbers::pi / 2) return;
  checker.complain(field, "its axis is " + printRounded(tilt) + " degrees from the direction to the viewer and its " +
                              "half-angle " + printRounded(cone.aperture) + " degrees, together " +
                              printRounded(tilt + cone.aperture) + ", must be below 90" + ending(frame));
}

void checkFront(Checker& checker, const ListedLight& light, LightFrame frame, const std::string& field,
                const glm::dvec3& viewer) {
  for (std::size_t i = 0; i < light.list.size(); ++i) {
    const glm::dvec3& direction = light.list[i].direction;
    const double towards = glm::dot(direction, viewer);
    if (!(towards > 0))
      checker.complain(field + ".list[" + std::to_string(i) + "].direction",
                       "is " + print(direction) + ", of which " + print(towards) +
                           " is towards the viewer, must be above 0" + ending(frame));
  }
}

// A map needs no check, since the half of it that is not in front is left out.
void checkFront(Checker&, const EnvironmentLight&, LightFrame, const std::string&, const glm::dvec3&) {}

}  // namespace

std::optional<Complaint> findComplaint(const LightSource& source, std::size_t number) {
  Checker checker;
  std::visit([&](const auto& light) { check(checker, light, nameOf(number)); }, source.light);
  return checker.complaint();
}

std::optional<Complaint> findBehindViewer(const LightSource& source, std::size_t number, const glm::dvec3& viewer) {
  Checker checker;
  std::visit([&](const auto& light) { checkFront(checker, light, source.frame, nameOf(number), viewer); },
             source.light);
  return checker.complaint();
}

}  // namespace umbrick
