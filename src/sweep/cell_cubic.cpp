// SPDX-License-Identifier: Apache-2.0
#include "sweep/cell_cubic.h"

#include <cmath>
#include <utility>

namespace umbrick {
namespace {

// Returns where the cubic, monotonic on [a, b], takes a value.
double crossing(const CellCubic& cubic, double value, double a, double b, bool rising) {
  constexpr double kEnough = 1e-12;
  const double atA = cubic(a) - value, atB = cubic(b) - value;
  // Where rounding has put an end on the wrong side, the crossing is that end.
  if ((atA > 0) == rising) return a;
  if ((atB > 0) != rising) return b;
  double s = a + (b - a) * (atA / (atA - atB));
  for (int i = 0; i < 60 && b - a > kEnough; ++i) {
    const double f = cubic(s) - value;
    ((f > 0) == rising ? b : a) = s;
    const double slope = cubic.c[1] + s * (2 * cubic.c[2] + 3 * s * cubic.c[3]);
    const double newton = s - f / slope;
    const double next = newton > a && newton < b ? newton : 0.5 * (a + b);
    if (std::abs(next - s) < kEnough) return next;
    s = next;
  }
  return s;
}

// Finds where the slope changes its sign in (0, 1). @return how often
int turnsOf(const CellCubic& cubic, std::array<double, 2>& places) {
  const double a = 3 * cubic.c[3], b = cubic.c[2], c = cubic.c[1];  // a s^2 + 2 b s + c
  const double root = b * b - a * c;
  if (!(root > 0)) return 0;
  // The sum of two numbers of one sign loses no digits.
  const double q = -(b + std::copysign(std::sqrt(root), b));
  int count = 0;
  for (const double s : {a != 0 ? q / a : -1.0, q != 0 ? c / q : -1.0})
    if (s > 0 && s < 1) places[static_cast<std::size_t>(count++)] = s;
  if (count == 2 && places[0] > places[1]) std::swap(places[0], places[1]);
  return count;
}

}  // namespace

CellCubic cubicBetween(const CellCorners& v, const glm::dvec3& p, const glm::dvec3& to) {
  const glm::dvec3 d = to - p;
  const double x = v[1] - v[0], y = v[2] - v[0], z = v[4] - v[0];
  const double xy = v[3] - v[1] - y, xz = v[5] - v[1] - z, yz = v[6] - v[2] - z;
  const double xyz = v[7] - v[5] - v[6] + v[4] - xy;
  CellCubic cubic;
  cubic.c[0] =
      v[0] + x * p.x + y * p.y + z * p.z + xy * p.x * p.y + xz * p.x * p.z + yz * p.y * p.z + xyz * p.x * p.y * p.z;
  cubic.c[1] = d.x * (x + xy * p.y + xz * p.z + xyz * p.y * p.z) + d.y * (y + xy * p.x + yz * p.z + xyz * p.x * p.z) +
               d.z * (z + xz * p.x + yz * p.y + xyz * p.x * p.y);
  cubic.c[2] = d.x * d.y * (xy + xyz * p.z) + d.x * d.z * (xz + xyz * p.y) + d.y * d.z * (yz + xyz * p.x);
  cubic.c[3] = d.x * d.y * d.z * xyz;
  return cubic;
}

CellCrossings crossingsOf(const CellCubic& cubic, double value, bool above) {
  std::array<double, 2> turns{};
  const int parts = turnsOf(cubic, turns) + 1;
  CellCrossings found;
  double a = 0;
  for (int i = 0; i < parts; ++i) {
    const double b = i + 1 < parts ? turns[static_cast<std::size_t>(i)] : 1;
    const bool next = cubic(b) > value;
    if (next != above) found.places[static_cast<std::size_t>(found.count++)] = crossing(cubic, value, a, b, next);
    above = next;
    a = b;
  }
  found.above = above;
  return found;
}

}  // namespace umbrick
