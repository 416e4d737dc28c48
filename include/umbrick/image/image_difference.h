// How far a picture is from its reference: in numbers, per pixel, and as a signed difference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "umbrick/image/flip.h"
#include "umbrick/image/image.h"

namespace umbrick {

struct DifferenceOptions {
  /// Linear RGB in [0, 1] that is seen behind the pictures; SSIM and FLIP only.
  glm::dvec3 background{0};
  double pixelsPerDegree = kFlipPixelsPerDegree;  // per degree of visual angle, in [1, 1000]; FLIP only
};

/// The difference in numbers. With a = test and b = reference, each mean is over all pixels and the channels that
/// are named, and the error of a pixel is e = largest |a - b| of its channels. Colour is linear and premultiplied,
/// as it is stored.
struct ImageDifference {
  double rmse = 0;                // sqrt(mean (a - b)^2) over all channels; those of a picture with alpha are RGBA
  std::optional<double> rmseRgb;  // the same over R, G and B; for 3 or 4 channels only
  double maxError = 0;            // largest e
  glm::ivec2 maxPixel{0};         // the first pixel that has it; row 0 is at the bottom
  double p999 = 0;                // 99.9th percentile: the smallest e that 99.9 % of the pixels do not exceed
  double relMse = 0;              // mean (a - b)^2 / (b^2 + 0.01) over R, G and B, or else over the channels there are
  std::optional<double> ssim;     // see ssim.h; for 3 or 4 channels and at least 11 x 11 pixels only
  std::optional<double> flip;     // mean of flipMap(), see flip.h; for 3 or 4 channels only
  std::uint64_t nonFiniteDiffering = 0;  // pixels that are NaN or infinite where the other image has something else
  std::uint64_t nonFiniteEqual = 0;      // other pixels that are NaN or infinite, the same in both images
};

/// Measures in double precision. The same input gives the same bits, whatever the number of threads.
///
/// Values that are not finite: the same infinity, or NaN, in both images counts as equal, since a depth is infinite
/// wherever nothing is seen. Anywhere else e is infinite, and so are maxError and rmse, and relMse if the channel
/// counts there. SSIM and FLIP compare what a screen shows, with NaN as 0, so a gate on them must look at
/// nonFiniteDiffering too.
/// Source of relMse: Rousselle, Knaus, Zwicker 2011, doi:10.1145/2070781.2024193.
///
/// @throw InvalidArgument  no pixels, sizes or channel counts that differ, or, with colour, an option out of range
ImageDifference differenceOf(const Image& test, const Image& reference, const DifferenceOptions& options = {});

/// Returns the error e of every pixel, as 1 channel; infinite at the pixels of nonFiniteDiffering.
/// @throw InvalidArgument  no pixels, sizes or channel counts that differ
Image errorMap(const Image& test, const Image& reference);

/// Returns test - reference, channel by channel; 0 where both hold the same infinity or NaN.
/// @throw InvalidArgument  no pixels, sizes or channel counts that differ
Image signedDifference(const Image& test, const Image& reference);

}  // namespace umbrick
