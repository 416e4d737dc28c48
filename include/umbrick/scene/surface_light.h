// The light that reaches surfaces, under models in which a medium occludes.
//
// A model with occlusion has a light L_i at each point: the sum over its directions of radiance times exp(-optical
// depth), as in a medium. Its share V, by colour, is L_i over the sum of the radiances: 1 where nothing is in the way.
// The medium that occludes is that of the transfer function, whether the mode shows it or not, and surfaces keep their
// opacity of the light away wherever it crosses them; beside a transfer function of value and gradient the medium alone
// occludes. A surface of a colour sends
//
//     flat     colour L_i
//     Phong    ambient colour + V (sum over lights of radiance (diffuse N.L colour + specular (R.V)^shininess))
//
// to the eye, all times light.ambient, where ambient, diffuse and specular are those of ShadingOptions: what is fully
// occluded shows its ambient share alone, and what nothing occludes looks as under the model emission. V dims all of
// Phong's lights alike. A medium that reflects light does the same at each of its points, whose albedo is the colour.
//
// Light is taken two voxels in front of a surface, see towardsLight(): light is known at voxels, from paths a voxel
// around them, so that nearer to the surface some of it would be that behind it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace umbrick {

/// Along the axis along which the way to it is longest, voxels.
inline constexpr int kSurfaceLightDistance = 2;
/// Bricks need an apron of this for light at surfaces.
inline constexpr int kSurfaceLightApron = kSurfaceLightDistance + 1;

/// Returns the way from a point of a surface to where its light is taken, in index coordinates.
/// @param toIndex  takes directions of the world to index space
/// @param normal   of the surface on the viewer's side, world, not 0
inline glm::dvec3 towardsLight(const glm::dmat3& toIndex, const glm::dvec3& normal) {
  const glm::dvec3 way = toIndex * normal;
  return way * (kSurfaceLightDistance / std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}));
}

}  // namespace umbrick
