// Totals of a volume from some of its layers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "umbrick/grid/plan.h"

namespace umbrick {

/// Returns the 97.5th percentile of Student's t, to a percent from 2 degrees of freedom on. Abramowitz and
/// Stegun 1964, 26.7.5.
inline double studentT(double degrees) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * degrees) + (5 * z5 + 16 * z3 + 3 * z) / (96 * degrees * degrees) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * degrees * degrees * degrees);
}

/// Estimates the total of all layers, see planGrid.
/// @param counts  one for each layer that was read; these are evenly spaced
/// @param layers  number of layers in all
/// @param most    largest count that a layer can have: where all counts are 0, as much may lie between two layers
inline Estimate totalOf(const std::vector<double>& counts, double layers, double most) {
  const auto n = static_cast<double>(counts.size());
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    sum += counts[k];
    if (k > 0) squares += (counts[k] - counts[k - 1]) * (counts[k] - counts[k - 1]);
  }
  Estimate total{sum * layers / n, 0};
  if (n >= layers) return total;
  if (sum == 0)
    total.uncertainty = (layers / n - 1) * most;
  else if (n > 1)
    total.uncertainty = studentT(n - 1) * layers * std::sqrt((1 - n / layers) / n * squares / (2 * (n - 1)));
  return total;
}

}  // namespace umbrick
