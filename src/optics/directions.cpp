// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/directions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {
constexpr double kGoldenAngle = 2.39996322972865332;  // pi (3 - sqrt(5))

// Returns two axes perpendicular to a unit vector. Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
std::pair<glm::dvec3, glm::dvec3> tangents(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

glm::dvec3 unit(const glm::dvec3& axis) {
  const double length = glm::length(axis);
  if (!(length > 0) || !std::isfinite(length)) throw InvalidArgument("directions: an axis has no direction");
  return axis / length;
}

glm::dvec3 around(const glm::dvec3& axis, const std::pair<glm::dvec3, glm::dvec3>& sides, double cosine, double phi) {
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  return glm::normalize(cosine * axis + sine * (std::cos(phi) * sides.first + std::sin(phi) * sides.second));
}

// Returns how many directions each ring takes, in proportion to its circumference: at least one each, and about
// `count` together.
std::vector<int> ringCounts(const std::vector<double>& sines, int count) {
  double sum = 0;
  for (const double sine : sines) sum += sine;
  std::vector<int> counts;
  double carried = 0;
  for (const double sine : sines) {
    carried += count * sine / sum;
    const int whole = std::max(1, static_cast<int>(std::lround(carried)));
    carried -= whole;
    counts.push_back(whole);
  }
  return counts;
}

void checkCone(double aperture, int count) {
  if (!(aperture >= 0 && aperture <= std::numbers::pi))
    throw InvalidArgument("aperture: expected [0, pi] rad, found " + std::to_string(aperture));
  if (count < 1) throw InvalidArgument("directions: expected at least 1, found " + std::to_string(count));
}
}  // namespace

std::vector<QuadratureNode> gaussLegendre(int count) {
  if (count < 1) throw InvalidArgument("quadrature: expected at least 1 node, found " + std::to_string(count));
  std::vector<QuadratureNode> nodes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    // Newton's iteration starts at the asymptotic place of the root. P comes from its three-term recurrence.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1, before = 0;
      for (int k = 1; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    nodes[static_cast<std::size_t>(i)] = {0.5 * (1 - x), 1 / ((1 - x) * (1 + x) * slope * slope)};
  }
  return nodes;
}

std::vector<WeightedDirection> coneDirections(const glm::dvec3& axis, double aperture, int count, double rotation) {
  checkCone(aperture, count);
  const glm::dvec3 pole = unit(axis);
  if (aperture == 0 || count == 1) return {{pole, 1}};
  const auto sides = tangents(pole);
  // The number of rings makes a ring about as far from the next as its directions are from each other.
  const double area = 2 * std::numbers::pi * (1 - std::cos(aperture));
  const int rings = std::max(1, static_cast<int>(std::lround(aperture / std::sqrt(area / count))));
  const std::vector<QuadratureNode> nodes = gaussLegendre(rings);
  std::vector<double> cosines, sines;
  for (const QuadratureNode& node : nodes) {
    cosines.push_back(1 - node.position * (1 - std::cos(aperture)));
    sines.push_back(std::sqrt(std::max(0.0, (1 - cosines.back()) * (1 + cosines.back()))));
  }
  const std::vector<int> counts = ringCounts(sines, count);
  std::vector<WeightedDirection> directions;
  for (std::size_t ring = 0; ring < nodes.size(); ++ring)
    for (int i = 0; i < counts[ring]; ++i) {
      const double phi = rotation + kGoldenAngle * static_cast<double>(ring) + 2 * std::numbers::pi * i / counts[ring];
      directions.push_back({around(pole, sides, cosines[ring], phi), nodes[ring].weight / counts[ring]});
    }
  return directions;
}

std::vector<WeightedDirection> spiralDirections(const glm::dvec3& axis, double aperture, int count, double rotation) {
  checkCone(aperture, count);
  const glm::dvec3 pole = unit(axis);
  if (aperture == 0 || count == 1) return {{pole, 1}};
  const auto sides = tangents(pole);
  const double height = 2 * std::sin(0.5 * aperture) * std::sin(0.5 * aperture);  // 1 - cos, without cancellation
  std::vector<WeightedDirection> directions;
  for (int i = 0; i < count; ++i)
    directions.push_back(
        {around(pole, sides, 1 - height * (i + 0.5) / count, rotation + kGoldenAngle * i), 1.0 / count});
  return directions;
}

std::vector<WeightedDirection> sphereDirections(int count, double rotation) {
  return coneDirections({0, 0, 1}, std::numbers::pi, count, rotation);
}

glm::dvec3 sampleCone(const glm::dvec3& axis, double aperture, double u, double v) {
  const glm::dvec3 pole = unit(axis);
  return around(pole, tangents(pole), 1 - u * (1 - std::cos(aperture)), 2 * std::numbers::pi * v);
}

}  // namespace umbrick
