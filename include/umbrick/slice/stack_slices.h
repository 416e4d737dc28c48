// Slices of stacks: planes across an axis of the volume, which stay where they are when the camera turns. Every ray
// is sampled by the stack of the axis that it runs along most, so that there is no view in which slices are seen from
// the side. Three stacks of 2D textures, for which the technique was made, are not needed: all stacks read the same
// 3D textures.
// Rezk-Salama et al. 2000, Interactive volume rendering on standard PC graphics hardware using multi-textures and
// multi-stage rasterization, doi:10.1145/346876.348238
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Slices across one axis, for the rays that run along it more than along the other two. The depth of a slice is how
/// far it is from the eye along that axis, in voxels, growing with the distance from the viewer.
struct StackAim {
  int axis = 2, sign = 1;  // of index space; sign: whether the index grows away from the viewer
  bool alone = true;       // all rays of the image belong to this stack
  /// How depth changes with view coordinates: that of the point at screen point p and view depth s is
  /// s dot(rate, (p, 1)) under perspective, and dot(rate, (p, s)) in a parallel view.
  glm::dvec3 rate{0, 0, 1};
  glm::dvec2 point{0};  // a screen point in the middle of the stack's part of the image
  double spacing = 1;   // voxels
  double phase = 0.5;   // see ProxySlices, in (0, 1]
};

/// Returns the stacks of a view: one in a parallel view, up to six in a wide one.
/// @param spacing  world units between slices along the ray in the middle of a stack; 0: the voxels' own slices
/// @param phase    see ProxySlices; has no effect on the voxels' own slices
std::vector<StackAim> aimStacks(const IndexView& view, double spacing, double phase = 0.5);

/// Cuts bricks by the slices of a stack. What is said of cutSlices() holds here, too; parameters as there.
/// @throw InvalidArgument  as cutSlices()
ProxySlices cutStack(const IndexView& view, const StackAim& aim, std::span<const glm::ivec3> origins,
                     const glm::ivec3& interior, std::span<const glm::dvec4> viewPlanes,
                     std::int64_t maxSlices = 1'000'000);

}  // namespace umbrick
