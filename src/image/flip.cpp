// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <numeric>

#include "image/comparable.h"
#include "image/plane.h"

namespace umbrick {
namespace {

// The matrix from linear sRGB to CIE XYZ, one column per primary, in the fractions of the program of the
// paper's authors.
const glm::dmat3 kToXyz(10135552 / 24577794.0, 2613072 / 12288897.0, 1425312 / 73733382.0,  // red
                        8788810 / 24577794.0, 8788810 / 12288897.0, 8788810 / 73733382.0,   // green
                        4435075 / 24577794.0, 887015 / 12288897.0, 70074185 / 73733382.0);  // blue
const glm::dmat3 kFromXyz = glm::inverse(kToXyz);
const glm::dvec3 kWhite = kToXyz * glm::dvec3(1);

// A picture in YCxCz, but without the factors and the offset that the definition gives the channels. Filters whose
// weights have the sum 1 neither see nor change them. y is luminance, Y / Y_white.
struct Opponent {
  Plane y, redGreen, blueYellow;  // y, x - y, y - z of XYZ over white
};

Opponent opponentOf(const Image& image, const glm::dvec3& background) {
  const Plane none(image.width, image.height);
  Opponent out{none, none, none};
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::dvec3 xyz = kToXyz * shownColour(image.at(x, y), image.channels, background) / kWhite;
        out.y.row(y)[x] = xyz.y;
        out.redGreen.row(y)[x] = xyz.x - xyz.y;
        out.blueYellow.row(y)[x] = xyz.y - xyz.z;
      }
  });
  return out;
}

// --- the colour pipeline of the paper ---

// A term of the contrast sensitivity, which is a sum of Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b), with d in degrees.
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053}, kBlueYellowWide{34.1, 0.04},
    kBlueYellowNarrow{13.5, 0.025};

double sigmaPixels(const Sensitivity& term, double pixelsPerDegree) {
  return pixelsPerDegree * std::sqrt(term.b / (2 * std::numbers::pi * std::numbers::pi));
}

// All filters reach 3 standard deviations of the widest one, in pixels.
int sensitivityRadius(double pixelsPerDegree) {
  return static_cast<int>(std::ceil(3 * sigmaPixels(kBlueYellowWide, pixelsPerDegree)));
}

Plane seenThrough(const Sensitivity& term, const Plane& plane, double pixelsPerDegree) {
  const Kernel kernel = normalised(gaussian(sigmaPixels(term, pixelsPerDegree), sensitivityRadius(pixelsPerDegree)));
  return filtered(plane, kernel, kernel);
}

// The two Gaussians have different widths, so only their sum is normalised, and each counts by its volume.
Plane seenThroughBlueYellow(const Plane& plane, double pixelsPerDegree) {
  const auto volume = [&](const Sensitivity& term) {
    const Kernel kernel = gaussian(sigmaPixels(term, pixelsPerDegree), sensitivityRadius(pixelsPerDegree));
    const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
    return term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum;
  };
  const double wide = volume(kBlueYellowWide), narrow = volume(kBlueYellowNarrow);
  Plane result = seenThrough(kBlueYellowWide, plane, pixelsPerDegree);
  const Plane other = seenThrough(kBlueYellowNarrow, plane, pixelsPerDegree);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = (wide * result.values[i] + narrow * other.values[i]) / (wide + narrow);
  return result;
}

Opponent filteredAsSeen(const Opponent& image, double pixelsPerDegree) {
  return {seenThrough(kAchromatic, image.y, pixelsPerDegree), seenThrough(kRedGreen, image.redGreen, pixelsPerDegree),
          seenThroughBlueYellow(image.blueYellow, pixelsPerDegree)};
}

// The curve of CIE 15: the cube root with a straight start.
double labCurve(double t) {
  constexpr double kDelta = 6 / 29.0;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4 / 29.0;
}

// Returns CIELAB of a linear RGB colour, with a and b scaled by lightness, which is Hunt's effect.
glm::dvec3 huntLab(const glm::dvec3& linear) {
  const glm::dvec3 xyz = kToXyz * linear / kWhite;
  const double x = labCurve(xyz.x), y = labCurve(xyz.y), z = labCurve(xyz.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

glm::dvec3 huntLab(const Opponent& image, std::size_t i) {
  const double y = image.y.values[i];
  const glm::dvec3 linear =
      kFromXyz * (glm::dvec3(y + image.redGreen.values[i], y, y - image.blueYellow.values[i]) * kWhite);
  return huntLab(glm::clamp(linear, 0.0, 1.0));
}

// Returns HyAB distance ^ q_c.
double colourDistance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), 0.7);
}

// Maps a distance to [0, 1]. Distances up to p_c of the largest one (green to blue) take the range up to p_t, and
// larger ones the rest.
double colourError(double distance) {
  static const double kLargest = colourDistance(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
  static const double kBend = 0.4 * kLargest;
  return distance < kBend ? 0.95 * distance / kBend : 0.95 + 0.05 * (distance - kBend) / (kLargest - kBend);
}

// --- the feature pipeline of the paper ---

// Scales a kernel so that its positive weights have the sum 1 and its negative ones the sum -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
  return kernel;
}

// The strength of edges and points: lengths of the first and second Gaussian derivatives along x and y.
struct Features {
  Plane edges, points;
};

Features featuresOf(const Plane& luminance, double pixelsPerDegree) {
  const double sigma = 0.5 * 0.082 * pixelsPerDegree;  // pixels; w = 0.082 degrees is twice the standard deviation
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const Kernel bell = gaussian(sigma, radius);
  Kernel slope = bell, bend = bell;
  for (int x = -radius; x <= radius; ++x) {
    slope[static_cast<std::size_t>(x + radius)] *= -x;
    bend[static_cast<std::size_t>(x + radius)] *= x * x / (sigma * sigma) - 1;
  }
  const auto length = [&](const Kernel& across) {
    Plane alongX = filtered(luminance, across, normalised(bell));
    const Plane alongY = filtered(luminance, normalised(bell), across);
    for (std::size_t i = 0; i < alongX.values.size(); ++i)
      alongX.values[i] = std::hypot(alongX.values[i], alongY.values[i]);
    return alongX;
  };
  return {length(balanced(slope)), length(balanced(bend))};
}

double featureError(const Features& a, const Features& b, std::size_t i) {
  const double edge = std::abs(a.edges.values[i] - b.edges.values[i]);
  const double point = std::abs(a.points.values[i] - b.points.values[i]);
  return std::sqrt(std::max(edge, point) / std::sqrt(2.0));
}

}  // namespace

Image flipMap(const Image& test, const Image& reference, const glm::dvec3& background, double pixelsPerDegree) {
  checkComparable(test, reference);
  checkColour(test);
  checkBackground(background);
  if (!(pixelsPerDegree >= 1 && pixelsPerDegree <= 1000))
    throw InvalidArgument("pixels per degree: expected 1 to 1000, found " + std::to_string(pixelsPerDegree));
  const Opponent a = opponentOf(test, background), b = opponentOf(reference, background);
  const Features featuresA = featuresOf(a.y, pixelsPerDegree), featuresB = featuresOf(b.y, pixelsPerDegree);
  const Opponent seenA = filteredAsSeen(a, pixelsPerDegree), seenB = filteredAsSeen(b, pixelsPerDegree);
  Image map(test.width, test.height, 1);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, map.pixels.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const double colour = colourError(colourDistance(huntLab(seenA, i), huntLab(seenB, i)));
      map.pixels[i] = static_cast<float>(std::pow(colour, 1 - featureError(featuresA, featuresB, i)));
    }
  });
  return map;
}

}  // namespace umbrick
