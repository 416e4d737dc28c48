// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/image_difference.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "image/comparable.h"
#include "umbrick/image/ssim.h"

namespace umbrick {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns true for the same number, the same infinity, or NaN in both.
bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

double absoluteError(float a, float b) {
  if (same(a, b)) return 0;
  return std::isfinite(a) && std::isfinite(b) ? std::abs(static_cast<double>(a) - b) : kInfinity;
}

double relativeSquare(double error, float reference) {
  constexpr double kSteady = 0.01;
  if (error == 0 || error == kInfinity) return error;
  return error * error / (static_cast<double>(reference) * reference + kSteady);
}

// What one row of pixels adds to the sums. Rows are added up in their order, so that threads do not
// change the rounding.
struct RowSums {
  double square = 0, squareRgb = 0, relative = 0;
  std::uint64_t differing = 0, equal = 0;
};

// Measures one row; `errors` receives the error e of each pixel.
RowSums measureRow(const Image& test, const Image& reference, int y, double* errors) {
  const int channels = test.channels;
  const int colours = hasColour(test) ? 3 : channels;
  RowSums sums;
  for (int x = 0; x < test.width; ++x) {
    const float *a = test.at(x, y), *b = reference.at(x, y);
    double largest = 0;
    bool finite = true;
    for (int c = 0; c < channels; ++c) {
      const double error = absoluteError(a[c], b[c]);
      largest = std::max(largest, error);
      finite = finite && std::isfinite(a[c]) && std::isfinite(b[c]);
      sums.square += error * error;
      if (c >= colours) continue;
      sums.squareRgb += error * error;
      sums.relative += relativeSquare(error, b[c]);
    }
    errors[x] = largest;
    if (!finite) ++(largest == kInfinity ? sums.differing : sums.equal);
  }
  return sums;
}

// Returns the smallest error that at least 99.9 % of all do not exceed.
double percentile999(std::vector<double> errors) {
  const auto rank = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() - errors.size() / 1000 - 1);
  std::nth_element(errors.begin(), rank, errors.end());
  return *rank;
}

}  // namespace

ImageDifference differenceOf(const Image& test, const Image& reference, const DifferenceOptions& options) {
  checkComparable(test, reference);
  const auto width = static_cast<std::size_t>(test.width), height = static_cast<std::size_t>(test.height);
  std::vector<double> errors(width * height);
  std::vector<RowSums> rows(height);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height), [&](const auto& range) {
    for (std::size_t y = range.begin(); y < range.end(); ++y)
      rows[y] = measureRow(test, reference, static_cast<int>(y), errors.data() + y * width);
  });
  RowSums sums;
  for (const RowSums& row : rows) {
    sums.square += row.square;
    sums.squareRgb += row.squareRgb;
    sums.relative += row.relative;
    sums.differing += row.differing;
    sums.equal += row.equal;
  }

  const auto pixels = static_cast<double>(errors.size());
  ImageDifference result;
  result.rmse = std::sqrt(sums.square / (pixels * test.channels));
  result.relMse = sums.relative / (pixels * (hasColour(test) ? 3 : test.channels));
  const auto largest = static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
  result.maxError = errors[largest];
  result.maxPixel = {static_cast<int>(largest % width), static_cast<int>(largest / width)};
  result.p999 = percentile999(std::move(errors));
  result.nonFiniteDiffering = sums.differing;
  result.nonFiniteEqual = sums.equal;
  if (!hasColour(test)) return result;
  result.rmseRgb = std::sqrt(sums.squareRgb / (pixels * 3));
  if (test.width >= kSsimWindow && test.height >= kSsimWindow)
    result.ssim = meanSsim(test, reference, options.background);
  const Image flip = flipMap(test, reference, options.background, options.pixelsPerDegree);
  result.flip = std::accumulate(flip.pixels.begin(), flip.pixels.end(), 0.0) / pixels;
  return result;
}

Image errorMap(const Image& test, const Image& reference) {
  checkComparable(test, reference);
  Image map(test.width, test.height, 1);
  std::vector<double> errors(static_cast<std::size_t>(test.width));
  for (int y = 0; y < test.height; ++y) {
    measureRow(test, reference, y, errors.data());
    std::transform(errors.begin(), errors.end(), map.at(0, y), [](double error) { return static_cast<float>(error); });
  }
  return map;
}

Image signedDifference(const Image& test, const Image& reference) {
  checkComparable(test, reference);
  Image difference(test.width, test.height, test.channels);
  std::transform(test.pixels.begin(), test.pixels.end(), reference.pixels.begin(), difference.pixels.begin(),
                 [](float a, float b) { return same(a, b) ? 0 : a - b; });
  return difference;
}

}  // namespace umbrick
