// How far a random scene's pictures are from what they should be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "fuzz/pictures/random_scene.h"
#include "umbrick/gl/context.h"

namespace umbrick {

/// Of two pictures, over all pixels and linear premultiplied R, G, B and A.
struct PictureDistance {
  double rms = 0, max = 0;
  glm::ivec2 worst{0};  // the pixel of `max`, row 0 at the bottom
};

struct VariantDistance {
  std::string name;
  PictureDistance from;  // the scene's own picture
  double limit = 0;      // of rms
};

struct SceneComparison {
  PictureDistance render;  // the scene's picture from the reference
  /// Emission: what its slabs alone make of the scene (slabPicture) from the reference, which is what the picture may
  /// be off by; 0 else.
  PictureDistance slabs;
  /// The same of slices a quarter of a voxel apart in four segments.
  PictureDistance fineRender, fineSlabs;
  PictureDistance reference;  // the reference's picture from cellPicture, another integrator; emission only
  double renderLimit = 0, fineLimit = 0, referenceLimit = 0;  // of rms; the largest number where there is none
  double depth = 0, depthLimit = 0;  // of the fine picture from the reference, RMS weighted by opacity, voxels
  std::vector<VariantDistance> variants;
  double opacity = 0;  // mean alpha of the reference
  double seconds = 0;
  /// One line per limit that was not kept; "base", "fine", "reference" or the name of a variant comes first. What was
  /// refused or not finite is a failure, too.
  std::vector<std::string> failures;
};

struct CompareOptions {
  /// So many of the variants, chosen by `seed`: each takes a table of the transfer function, which is most of the time.
  int variants = 100;
  std::uint64_t seed = 1;
};

/// Renders the scene and its variants, and has the reference integrate it.
///
/// Emission is held to what its slabs can do: with e the RMSE of slabPicture, the limit is 1.25 e + kFloor. Fine slabs
/// are held to the same with their own e, so that pictures must converge where slabs do. The reference is held to
/// cellPicture, which knows no bricks either, by as much as that changes with the parts of a cell. Cones and lights are
/// compared with the reference by the same directions, without a limit. Variants of every model must agree but for
/// rounding, which is known by what a displacement of all samples by as much changes.
/// @pre `context` is current
SceneComparison compareScene(const GlContext& context, const RandomScene& random, const CompareOptions& options = {});

}  // namespace umbrick
