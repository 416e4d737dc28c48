// A camera that goes around something.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/core/camera.h"

namespace umbrick {

/// Returns the camera turned as a whole around an axis, so that what it sees from elsewhere keeps its size and its
/// place in the picture. Around the centre of what an orbit looks at, and its up, that is the orbit's camera at another
/// azimuth.
/// @param centre  a point of the axis, world units
/// @param axis    of any length but 0
/// @param angle   rad, counter-clockwise where the axis points to the viewer
/// @throw InvalidArgument  the axis has no length
Camera turnedCamera(const Camera& camera, const glm::dvec3& centre, const glm::dvec3& axis, double angle);

/// Returns how far the picture turns around its middle from one camera to another, rad, in [0, pi], besides what must
/// turn where the direction of view changes (as little as possible). It is large where a camera passes a direction of
/// view along its up, and the picture is upside down from then on.
/// @throw InvalidArgument  as cameraFrame
double rollBetween(const Camera& from, const Camera& to);

}  // namespace umbrick
