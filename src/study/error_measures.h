// How far a picture of a study is from its reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "umbrick/image/image.h"

namespace umbrick {

/// See ImageDifference; of R, G and B alone, so that an exact alpha does not hide an error of colour.
struct ErrorMeasures {
  double rmse = 0, maxError = 0, p999 = 0, relMse = 0;
  std::optional<double> ssim, flip;
  bool operator==(const ErrorMeasures&) const = default;
};

/// @throw InvalidArgument  sizes that differ
ErrorMeasures measureError(const Image& test, const Image& reference);

/// R, G and B of a picture.
Image colourOf(const Image& picture);

}  // namespace umbrick
