// A scene's mesh as all techniques show it: the end of each ray, and what is seen there.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// What the rays of a picture meet of a mesh first.
struct MeshPicture {
  Image colour;  // linear RGB
  Image depth;   // along the view axis, world units, 1 channel; infinite where no mesh is met
};

/// Checks whether a scene's mesh can be shaded, where it has one. @throw InvalidArgument  as shadingLights
void checkMesh(const ResolvedScene& scene);

/// @param sample  of the picture that ends there
/// @throw InvalidArgument  as shadingLights
/// @pre scene.mesh.shape
MeshPicture drawMesh(const ResolvedScene& scene, const RenderSample& sample);

/// Lays a picture without a background, whose rays end at the mesh, over it, and both over the scene's background.
/// Where the mesh is seen the picture is opaque, and the mesh counts in V and depth as what nothing occludes; layers of
/// numbers stay those of the volume.
void layOverMesh(const ResolvedScene& scene, const MeshPicture& mesh, Picture& picture);

/// Returns the scene whose picture is laid over a mesh: without a background.
ResolvedScene beforeMesh(const ResolvedScene& scene);

}  // namespace umbrick
