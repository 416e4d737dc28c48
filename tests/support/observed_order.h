// How fast an error falls. Etiene et al. 2014, "Verifying Volume Rendering Using Discretization Error Analysis",
// doi:10.1109/TVCG.2013.90
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "umbrick/image/image.h"

namespace umbrick {

/// Exponent p of error = c step^p, by least squares of the logarithms.
inline double observedOrder(const std::vector<double>& steps, const std::vector<double>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double a = std::log(steps[i]), b = std::log(errors[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Root mean square difference over pixels and channels.
inline double rmsDifference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

/// A picture read between its pixels: linear, at the pixel centres of one `factor` times as large.
struct Enlarged {
  Image image;
  int margin = 0;  // pixels of the larger picture along each edge that are not interpolated
};
inline Enlarged enlarge(const Image& small, int factor) {
  Enlarged large{Image(small.width * factor, small.height * factor, small.channels), (factor + 1) / 2};
  for (int y = large.margin; y < large.image.height - large.margin; ++y)
    for (int x = large.margin; x < large.image.width - large.margin; ++x) {
      const double px = (x + 0.5) / factor - 0.5, py = (y + 0.5) / factor - 0.5;
      const int left = static_cast<int>(std::floor(px)), bottom = static_cast<int>(std::floor(py));
      const double fx = px - left, fy = py - bottom;
      for (int c = 0; c < small.channels; ++c)
        large.image.at(x, y)[c] = static_cast<float>(
            (1 - fy) * ((1 - fx) * small.at(left, bottom)[c] + fx * small.at(left + 1, bottom)[c]) +
            fy * ((1 - fx) * small.at(left, bottom + 1)[c] + fx * small.at(left + 1, bottom + 1)[c]));
    }
  return large;
}

/// Root mean square over the pixels that are interpolated.
inline double rmsDifference(const Enlarged& large, const Image& exact) {
  double sum = 0, count = 0;
  for (int y = large.margin; y < exact.height - large.margin; ++y)
    for (int x = large.margin; x < exact.width - large.margin; ++x)
      for (int c = 0; c < exact.channels; ++c) {
        const double difference = static_cast<double>(large.image.at(x, y)[c]) - static_cast<double>(exact.at(x, y)[c]);
        sum += difference * difference;
        ++count;
      }
  return std::sqrt(sum / count);
}

}  // namespace umbrick
