// Pictures that should be the same: how far apart they are, and how far they may be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <string>

#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// Largest differences of two pictures. Colour in units of the ambient radiance; depth weighted by opacity and relative
/// to the farthest slice, so that all are comparable.
struct PictureDifference {
  double colour = 0, visibility = 0, depth = 0;
};
PictureDifference difference(const Picture& a, const Picture& b, const ResolvedScene& scene, double farthest);

/// Limits that pictures of equal samples keep.
struct PictureLimit {
  PictureDifference rounding;  // of samples and of sums
  double light = 0;            // dos: what the sweep leaves out of light that walks far
};

/// @param shifted   difference that a displacement of all samples makes, by as much as rounding may move them
/// @param slices    that add up along a pixel
PictureLimit pictureLimit(const PictureDifference& shifted, const ResolvedScene& scene, std::int64_t slices);

/// The layer that is nearest to its limit.
struct LayerShare {
  double value = 0, limit = 0;
  std::string layer;
};
/// @param extra  added to the limit of each layer
LayerShare worstLayer(const PictureDifference& difference, const PictureLimit& limit, double extra);

/// How much steeper V is across projected brick faces than in the other picture: largest excess of the step between two
/// neighbouring pixels on either side of a face of constant x or z. For parallel views straight at the faces.
double seamExcess(const Picture& bricked, const Picture& other, const ResolvedScene& scene, const Bricks& bricks,
                  std::size_t& pairs);

}  // namespace umbrick
