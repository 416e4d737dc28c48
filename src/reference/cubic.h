// Polynomials of degree three: what trilinear interpolation is along a line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace umbrick {

/// The polynomial c[0] + c[1] s + c[2] s^2 + c[3] s^3.
struct Cubic {
  std::array<double, 4> c{};

  double operator()(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
  /// Returns the integral over [a, b]. Two Gauss nodes make it exact, without the cancellation that a difference of
  /// antiderivatives has.
  double integral(double a, double b) const {
    constexpr double node = 0.21132486540518712;
    const double h = b - a;
    return 0.5 * h * ((*this)(a + node * h) + (*this)(b - node * h));
  }
  /// Finds the places in (0, 1) where the slope changes sign, in ascending order, and returns their number.
  int turns(std::array<double, 2>& places) const {
    int count = 0;
    const auto add = [&](double s) {
      if (s > 0 && s < 1) places[static_cast<std::size_t>(count++)] = s;
    };
    const double a = 3 * c[3], half = c[2], b = c[1];  // the slope is a s^2 + 2 half s + b
    const double root = half * half - a * b;
    if (root < 0) return 0;
    // The larger root comes first, and the other one from their product, so that nothing cancels.
    const double q = -(half + std::copysign(std::sqrt(root), half));
    if (a != 0) add(q / a);
    if (q != 0) add(b / q);
    if (count == 2 && places[0] > places[1]) std::swap(places[0], places[1]);
    return count;
  }
  /// Returns where the cubic, which must be monotonic on [a, b], takes a value that lies between those at the ends, to
  /// 1e-13. Newton's steps start where the chord takes the value, and stay inside a bracket that shrinks.
  double solve(double value, double a, double b) const {
    const double fa = (*this)(a)-value, fb = (*this)(b)-value;
    const bool rising = fb >= fa;
    double s = fa != fb ? std::clamp(a + (b - a) * (fa / (fa - fb)), a, b) : a;
    for (int i = 0; i < 60; ++i) {
      const double f = (*this)(s)-value;
      ((f < 0) == rising ? a : b) = s;
      const double newton = s - f / (c[1] + s * (2 * c[2] + 3 * s * c[3]));
      const double next = newton >= a && newton <= b ? newton : 0.5 * (a + b);
      if (std::abs(next - s) < 1e-13) return next;
      s = next;
    }
    return s;
  }
};

}  // namespace umbrick
