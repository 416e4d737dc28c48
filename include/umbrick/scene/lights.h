// The light that a point scatters, as directions with a radiance each.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "umbrick/scene/resolve.h"

namespace umbrick {

/// One direction of the light around a point. A point of albedo 1 with transmittances T_k towards the light scatters
/// L_a * sum_k radiance_k T_k, with L_a = scene.ambient, which tints every model. All directions lie in the open
/// hemisphere that the viewer is in, unless lightComesFromBehind() (capabilities.h).
struct LightDirection {
  glm::dvec3 direction;  // towards the light, unit length, world
  glm::dvec3 radiance;   // weight times colour; for `cone` all components are the weight, and the weights sum to 1
  bool operator==(const LightDirection&) const = default;
};

/// Returns about `count` directions for the light of a scene whose model is cone, ambient or lights. They are the same
/// for the same arguments. A cone gives spiralDirections, or coneDirections from 65 directions on; an environment map
/// gives its median cut (Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling"), which keeps all of its
/// light. Lights of one direction and explicit lists are taken as they are, whatever `count` is.
///
/// The other sources share the rest in proportion to their power times the square root of their solid angle, and each
/// gets at least one: for directions placed at random this makes the variance of the sum least (Neyman 1934). Power is
/// the mean of R, G and B where nothing is in the way. A map is walked in every call: 70 ms of one core for
/// 2048 x 1024 pixels, 30 ms in lightSamples.
/// @param rotation  rad; other sets of the same light, whose mean is a finer one
/// @throw InvalidArgument  the model is emission or coneRay; count < 1; a light does not fit the viewer's hemisphere,
///   where it has to (the message names it)
std::vector<LightDirection> lightDirections(const ResolvedScene& scene, int count, double rotation = 0);

/// Returns points first, first + 1, ..., first + count - 1 of a low-discrepancy sequence of directions, of equal weight
/// within a light. Sets that follow each other average to their union, and the union gets finer as a whole. Points are
/// those of the sequence R2 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"). They are carried
/// to each cone by a map that keeps areas, and to an environment by inversion of its power along rows and columns.
///
/// Every set is the whole light: shares are those of lightDirections(count), so a source that gets n of a set continues
/// its own sequence at first n / count, and lights of one direction and lists come in every set. Over seeds each set by
/// itself has the light's exact mean.
/// @param seed  shifts the sequence (Cranley and Patterson 1976)
/// @throw InvalidArgument  as lightDirections
std::vector<LightDirection> lightSamples(const ResolvedScene& scene, std::uint64_t first, int count,
                                         std::uint64_t seed);

}  // namespace umbrick
