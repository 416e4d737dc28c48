// An axis of the world with its sign: which way is up, which way a thing faces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/core/names.h"

namespace umbrick {

enum class Axis {
  automatic,  // it follows from the volume
  x,
  y,
  z,
  minusX,
  minusY,
  minusZ,
};
inline constexpr Name<Axis> kAxes[]{
    {"auto", Axis::automatic}, {"x", Axis::x},       {"y", Axis::y},      {"z", Axis::z},
    {"-x", Axis::minusX},      {"-y", Axis::minusY}, {"-z", Axis::minusZ}};

/// Returns the unit vector of an axis. @throw InvalidArgument  it is `automatic`
glm::dvec3 axisDirection(Axis axis);

/// Returns the way a thing faces whose file says only what is up. With z up that is -y, the usual view of a patient who
/// lies along z; with y up it is +z, the usual view of programs that make effects. Seen from there, +x points to the
/// right (to the left where the axis that is up is negative). @throw InvalidArgument  up is `automatic`
Axis usualFront(Axis up);

}  // namespace umbrick
