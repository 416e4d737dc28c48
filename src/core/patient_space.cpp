// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/patient_space.h"

#include <glm/geometric.hpp>

namespace umbrick {

std::optional<PatientAxes> patientAxes(std::string_view space) {
  if (space.size() != 3) return std::nullopt;
  PatientAxes axes;
  for (int axis = 0; axis < 3; ++axis) {
    const char letter = space[static_cast<std::size_t>(axis)];
    if (letter == 'L' || letter == 'R') axes.left[axis] = letter == 'L' ? 1 : -1;
    if (letter == 'P' || letter == 'A') axes.posterior[axis] = letter == 'P' ? 1 : -1;
    if (letter == 'S' || letter == 'I') axes.superior[axis] = letter == 'S' ? 1 : -1;
  }
  // A letter that comes twice, or none of its pair, leaves an axis of the wrong length.
  for (const glm::dvec3& axis : {axes.left, axes.posterior, axes.superior})
    if (glm::dot(axis, axis) != 1) return std::nullopt;
  return axes;
}

std::optional<glm::dmat4> changeOfSpace(std::string_view from, std::string_view to) {
  const std::optional<PatientAxes> before = patientAxes(from), after = patientAxes(to);
  if (!before || !after) return std::nullopt;
  const glm::dmat3 body(before->left, before->posterior, before->superior);
  return glm::dmat4(glm::dmat3(after->left, after->posterior, after->superior) * glm::transpose(body));
}

}  // namespace umbrick
