// Where the medium ends, as planes in index coordinates.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Returns the half-spaces dot(xyz, index) + w >= 0 that the medium lies in: the scene's clip planes and box, its near
/// plane and, where the background is visible, the faces of the medium.
std::vector<glm::dvec4> indexPlanes(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible);

/// Returns the half-space in front of the eye, of which parallel views are in need.
glm::dvec4 frontPlane(const ResolvedScene& scene, const Bricks& volume);

}  // namespace umbrick
