// SPDX-License-Identifier: Apache-2.0
#include "image/plane.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace umbrick {
namespace {

int radiusOf(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

// Adds whole rows, one weight after the other, in a loop without branches that the compiler turns into vectors.
void addScaled(double* sum, const double* values, double weight, int count) {
  for (int x = 0; x < count; ++x) sum[x] += weight * values[x];
}

Plane filteredAlongX(const Plane& in, const Kernel& kernel) {
  const int radius = radiusOf(kernel);
  Plane out(in.width, in.height);
  tbb::parallel_for(tbb::blocked_range<int>(0, in.height), [&](const tbb::blocked_range<int>& rows) {
    std::vector<double> padded(static_cast<std::size_t>(in.width + 2 * radius));
    for (int y = rows.begin(); y < rows.end(); ++y) {
      const double* row = in.row(y);
      std::fill_n(padded.begin(), radius, row[0]);
      std::copy_n(row, in.width, padded.begin() + radius);
      std::fill_n(padded.begin() + radius + in.width, radius, row[in.width - 1]);
      for (std::size_t i = 0; i < kernel.size(); ++i) addScaled(out.row(y), padded.data() + i, kernel[i], in.width);
    }
  });
  return out;
}

Plane filteredAlongY(const Plane& in, const Kernel& kernel) {
  const int radius = radiusOf(kernel);
  Plane out(in.width, in.height);
  tbb::parallel_for(tbb::blocked_range<int>(0, in.height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y)
      for (int i = -radius; i <= radius; ++i)
        addScaled(out.row(y), in.row(std::clamp(y + i, 0, in.height - 1)), kernel[static_cast<std::size_t>(i + radius)],
                  in.width);
  });
  return out;
}

}  // namespace

Kernel gaussian(double sigma, int radius) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
  return kernel;
}

Kernel normalised(Kernel kernel) {
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

Plane filtered(const Plane& in, const Kernel& alongX, const Kernel& alongY) {
  return filteredAlongY(filteredAlongX(in, alongX), alongY);
}

}  // namespace umbrick
