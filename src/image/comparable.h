// What two images must have in common to be compared, and what a screen shows of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/image/image.h"

namespace umbrick {

inline std::string sizeText(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

inline void checkComparable(const Image& test, const Image& reference) {
  if (test.width < 1 || test.height < 1 || test.channels < 1)
    throw InvalidArgument("images to compare: expected pixels, found " + sizeText(test));
  if (test.width != reference.width || test.height != reference.height)
    throw InvalidArgument("images to compare: " + sizeText(test) + " beside " + sizeText(reference) + " pixels");
  if (test.channels != reference.channels)
    throw InvalidArgument("images to compare: " + std::to_string(test.channels) + " beside " +
                          std::to_string(reference.channels) + " channels");
}

inline bool hasColour(const Image& image) { return image.channels == 3 || image.channels == 4; }

inline void checkColour(const Image& image) {
  if (!hasColour(image))
    throw InvalidArgument("images to look at: expected 3 or 4 channels, found " + std::to_string(image.channels));
}

inline void checkBackground(const glm::dvec3& background) {
  for (int c = 0; c < 3; ++c)
    if (!(background[c] >= 0 && background[c] <= 1))
      throw InvalidArgument("background: expected linear RGB in [0, 1], found " + std::to_string(background[c]));
}

// Returns the value that a screen shows, in [0, 1]. NaN is 0, as in a PNG file.
inline double shownValue(double value) { return std::isnan(value) ? 0 : std::clamp(value, 0.0, 1.0); }

/// Returns linear RGB in [0, 1] of a pixel of 3 channels, or of 4 premultiplied channels over the background.
inline glm::dvec3 shownColour(const float* pixel, int channels, const glm::dvec3& background) {
  const double through = channels == 4 ? 1 - shownValue(pixel[3]) : 0;
  glm::dvec3 shown;
  for (int c = 0; c < 3; ++c) shown[c] = shownValue(pixel[c] + through * background[c]);
  return shown;
}

}  // namespace umbrick
