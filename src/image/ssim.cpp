// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/ssim.h"

#include <glm/geometric.hpp>

#include "image/comparable.h"
#include "image/plane.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

Plane encodedLuminance(const Image& image, const glm::dvec3& background) {
  const glm::dvec3 rec709(0.2126, 0.7152, 0.0722);
  Plane plane(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      plane.row(y)[x] = linearToSrgb(glm::dot(rec709, shownColour(image.at(x, y), image.channels, background)));
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.width, a.height);
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] = a.values[i] * b.values[i];
  return result;
}

}  // namespace

double meanSsim(const Image& test, const Image& reference, const glm::dvec3& background) {
  checkComparable(test, reference);
  checkColour(test);
  checkBackground(background);
  if (test.width < kSsimWindow || test.height < kSsimWindow)
    throw InvalidArgument("SSIM: expected at least 11 x 11 pixels, found " + sizeText(test));
  constexpr double kSteadyMean = 0.01 * 0.01, kSteadyVariance = 0.03 * 0.03;  // C1 and C2 for values in [0, 1]
  constexpr int kRadius = kSsimWindow / 2;
  const Kernel window = normalised(gaussian(1.5, kRadius));
  const auto mean = [&](const Plane& plane) { return filtered(plane, window, window); };

  const Plane a = encodedLuminance(test, background), b = encodedLuminance(reference, background);
  const Plane meanA = mean(a), meanB = mean(b);
  const Plane squareA = mean(product(a, a)), squareB = mean(product(b, b)), mixed = mean(product(a, b));
  double sum = 0;
  for (int y = kRadius; y < test.height - kRadius; ++y)
    for (int x = kRadius; x < test.width - kRadius; ++x) {
      const double ma = meanA.row(y)[x], mb = meanB.row(y)[x];
      // In this order of operations a window that is equal in both pictures gives 1 to the last bit.
      const double variances = (squareA.row(y)[x] - ma * ma) + (squareB.row(y)[x] - mb * mb);
      const double covariance = mixed.row(y)[x] - ma * mb;
      sum += (2 * ma * mb + kSteadyMean) * (2 * covariance + kSteadyVariance) /
             ((ma * ma + mb * mb + kSteadyMean) * (variances + kSteadyVariance));
    }
  return sum / (static_cast<double>(test.width - 2 * kRadius) * static_cast<double>(test.height - 2 * kRadius));
}

}  // namespace umbrick
