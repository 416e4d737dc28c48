// Where the medium that a camera sees ends, as planes in view coordinates.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Returns the planes that cut slabs: the scene's clip planes and box, its near plane and, where the background is
/// visible, the faces of the medium.
std::vector<glm::dvec4> viewPlanes(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible);

/// Returns the planes beyond which there is nothing to draw: those above, and the faces of the medium even where they
/// cut no slab, since the background is invisible.
std::vector<glm::dvec4> viewBounds(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible,
                                   std::vector<glm::dvec4> planes);

/// Returns a plane of view coordinates in index coordinates. It is not normalised.
glm::dvec4 planeInIndex(const glm::dvec4& plane, const IndexView& view);

/// Returns the longest diagonal of the volume's domain, world units. A crooked volume has four of different lengths.
double domainDiagonal(const Bricks& volume);

}  // namespace umbrick
