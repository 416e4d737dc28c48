// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/error_measures.h"

#include <algorithm>

#include "umbrick/image/image_difference.h"

namespace umbrick {

Image colourOf(const Image& picture) {
  Image colour(picture.width, picture.height, 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) std::copy_n(picture.at(x, y), 3, colour.at(x, y));
  return colour;
}

ErrorMeasures measureError(const Image& test, const Image& reference) {
  const ImageDifference difference = differenceOf(colourOf(test), colourOf(reference));
  return {difference.rmse, difference.maxError, difference.p999, difference.relMse, difference.ssim, difference.flip};
}

}  // namespace umbrick
