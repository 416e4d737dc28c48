// Measures how far a picture of a study is from its reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "umbrick/image/image.h"

namespace umbrick {

/// The measures of ImageDifference (each is explained there), of linear premultiplied R, G and B alone: an exact alpha
/// must not hide an error of colour. SSIM is missing for pictures below 11 x 11 pixels.
struct ErrorMeasures {
  double rmse = 0, maxError = 0, p999 = 0, relMse = 0;
  std::optional<double> ssim, flip;
  bool operator==(const ErrorMeasures&) const = default;
};

/// Measures the error of a picture. @throw InvalidArgument  the sizes differ
ErrorMeasures measureError(const Image& test, const Image& reference);

/// Returns the picture without its alpha: three channels.
Image colourOf(const Image& picture);

}  // namespace umbrick
