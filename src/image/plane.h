// One channel in double precision, and filters that act along rows and columns.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace umbrick {

/// A channel of width x height values, row by row.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  double* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const double* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// The weights of a filter at offsets -radius to radius, so an odd number of them.
using Kernel = std::vector<double>;

/// Returns the weights exp(-x^2 / (2 sigma^2)), not normalised.
Kernel gaussian(double sigma, int radius);
/// Returns the kernel divided by the sum of its weights.
Kernel normalised(Kernel kernel);

/// Returns out(x, y) = sum over i, j of alongX[i] alongY[j] in(x + i, y + j), computed on all threads. Beyond its
/// border the image continues with the values of the border.
Plane filtered(const Plane& in, const Kernel& alongX, const Kernel& alongY);

}  // namespace umbrick
