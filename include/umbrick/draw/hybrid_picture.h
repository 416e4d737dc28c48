// The mode hybrid as all techniques put it together: a surface for each ray, and the medium behind it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// The first surface that each ray meets.
struct FirstSurfaces {
  /// Colour without a background. Layers besides colour are those of isosurfaces; what has no surface is nothing there.
  Picture picture;
  /// The depth along the view axis from which the medium is seen, world units, 1 channel. Infinite where it is not: no
  /// surface is met, or one that lets through less than the scene's saturation.
  Image start;
};

/// Returns the scene whose medium lies behind the surfaces: a medium as of the mode integrate, which is shaded where
/// Phong's model is asked for by name. Light in it knows nothing of the surfaces.
ResolvedScene mediumBehind(const ResolvedScene& scene);

/// Returns the depth from which the medium behind a surface is seen. @param opacity  of the surface
double startBehind(const ResolvedScene& scene, double depth, double opacity);

/// Composites surfaces over the medium and over the scene's background.
/// @param medium  of mediumBehind(), each ray from its start on
Picture composite(const ResolvedScene& scene, FirstSurfaces surfaces, const Picture& medium);

}  // namespace umbrick
