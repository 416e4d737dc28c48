// Pictures made by formulas that a few lines in any language repeat, for numbers computed elsewhere.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>

#include "umbrick/image/image.h"

namespace umbrick {

enum class Formula { smooth, shifted, checks, waves, noise, flat };

/// Returns 64 x 48 pixels of linear RGB, rounded to float, with alpha 1; y counts from row 0.
inline Image formulaPicture(Formula formula) {
  Image image(64, 48, 4);
  const auto put = [&](int x, int y, double r, double g, double b) {
    float* pixel = image.at(x, y);
    pixel[0] = static_cast<float>(r);
    pixel[1] = static_cast<float>(g);
    pixel[2] = static_cast<float>(b);
    pixel[3] = 1;
  };
  const auto mix = [&](int x, int y, double c) { put(x, y, 0.1 + 0.8 * c, 0.1 + 0.6 * c, 0.3 - 0.2 * c); };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) switch (formula) {
        case Formula::smooth:
          put(x, y, 0.5 + 0.4 * std::sin(0.21 * x + 0.05 * y), 0.5 + 0.4 * std::sin(0.13 * y + 1),
              0.5 + 0.4 * std::cos(0.17 * x - 0.11 * y));
          break;
        case Formula::shifted:  // as smooth, but one pixel to the right and with another green
          put(x, y, 0.5 + 0.4 * std::sin(0.21 * (x - 1) + 0.05 * y), 0.5 + 0.4 * std::sin(0.13 * y + 1.3),
              0.5 + 0.4 * std::cos(0.17 * (x - 1) - 0.11 * y));
          break;
        case Formula::checks:
          mix(x, y, (x / 8 + y / 6) % 2);
          break;
        case Formula::waves:  // smooth where checks are sharp, bright where they are dark
          mix(x, y, 0.5 + 0.5 * std::sin(std::numbers::pi * x / 8) * std::sin(std::numbers::pi * y / 6));
          break;
        case Formula::noise: {
          const double r = (x * 131 + y * 197) % 89 / 88.0, g = (x * 53 + y * 151) % 97 / 96.0,
                       b = (x * 17 + y * 89) % 101 / 100.0;
          put(x, y, r * r, g * g, b * b);
          break;
        }
        case Formula::flat:
          put(x, y, 0.25, 0.5, 0.125);
          break;
      }
  return image;
}

/// Returns `width` x `height` pixels of one linear premultiplied colour.
inline Image solid(int width, int height, float r, float g, float b, float a = 1) {
  Image image(width, height, 4);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    image.pixels[i] = r;
    image.pixels[i + 1] = g;
    image.pixels[i + 2] = b;
    image.pixels[i + 3] = a;
  }
  return image;
}

}  // namespace umbrick
