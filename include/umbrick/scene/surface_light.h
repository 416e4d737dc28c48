// The light that reaches surfaces, under models in which a medium occludes.
//
// A model with occlusion has a light L_i at each point: the sum over its directions of radiance times exp(-optical
// depth), as in a medium. Its share V, by colour, is L_i over the sum of the radiances: 1 where nothing is in the way.
// The medium that occludes is that of the transfer function, whether the mode shows it or not. Surfaces by themselves
// cast no shadow; a function that is dense from the value of a surface on makes it cast one. A surface of a colour
// sends
//
//     flat     colour L_i
//     Phong    ambient colour + V sum over lights of radiance (diffuse N.L colour + specular (R.V)^shininess)
//
// to the eye, all times light.ambient, where ambient, diffuse and specular are those of ShadingOptions: what is fully
// occluded shows its ambient share alone, and what nothing occludes looks as under the model emission. V dims all of
// Phong's lights alike. A medium that reflects light does the same at each of its points, whose albedo is the colour.
//
// Light is taken a voxel in front of a surface, see towardsLight(): values between voxels say no more of where a
// surface lies, and light at voxels behind it, which a dense medium may keep all light from, does not count then.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace umbrick {

/// Along the axis along which the way to it is longest, voxels.
inline constexpr double kSurfaceLightDistance = 1;

/// Returns the way from a point of a surface to where its light is taken, in index coordinates.
/// @param toIndex  takes directions of the world to index space
/// @param normal   of the surface on the viewer's side, world, not 0
inline glm::dvec3 towardsLight(const glm::dmat3& toIndex, const glm::dvec3& normal) {
  const glm::dvec3 way = toIndex * normal;
  return way * (kSurfaceLightDistance / std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}));
}

}  // namespace umbrick
