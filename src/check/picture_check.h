// Compares pictures that should be the same: how far apart they are, and how far apart they may be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <string>

#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// The largest differences of two pictures. Colour is in units of the ambient radiance; depth is weighted by opacity
/// and relative to the farthest slice. So all of them are comparable.
struct PictureDifference {
  double colour = 0, visibility = 0, depth = 0;
};
PictureDifference difference(const Picture& a, const Picture& b, const ResolvedScene& scene, double farthest);

/// How far pictures of equal samples may be apart.
struct PictureLimit {
  PictureDifference rounding;  // from rounding of samples and of sums
  double light = 0;            // dos: the part of the light which walks far that the sweep leaves out
};

/// Returns how far two pictures may be apart.
/// @param shifted  difference that a displacement of all samples makes, by as much as rounding may move them
/// @param slices  number of slices that add up along a pixel
PictureLimit pictureLimit(const PictureDifference& shifted, const ResolvedScene& scene, std::int64_t slices);

/// A layer and how much of its limit its difference takes.
struct LayerShare {
  double value = 0, limit = 0;
  std::string layer;
};
/// Returns the layer that is nearest to its limit. @param extra  added to the limit of each layer
LayerShare worstLayer(const PictureDifference& difference, const PictureLimit& limit, double extra);

/// Returns how much steeper V is across projected brick faces than in the other picture: the largest excess of the step
/// between two neighbouring pixels on either side of a face of constant x or z. It is meant for parallel views straight
/// at the faces.
double seamExcess(const Picture& bricked, const Picture& other, const ResolvedScene& scene, const Bricks& bricks,
                  std::size_t& pairs);

}  // namespace umbrick
