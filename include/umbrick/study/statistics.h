// Numbers from measurements: spread of times, Pareto front, order of convergence.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace umbrick {

/// Order statistics of repeated measurements.
struct Spread {
  double least = 0, lowerQuartile = 0, median = 0, upperQuartile = 0, most = 0;
  bool operator==(const Spread&) const = default;
};

/// Quantiles are linear between the measurements in order (type 7 of Hyndman and Fan 1996).
/// @throw InvalidArgument  no values
Spread spreadOf(std::vector<double> values);

/// Each numerator over the denominator at its place. @throw InvalidArgument  lists of different length
std::vector<double> ratios(std::span<const double> numerators, std::span<const double> denominators);

/// What a picture costs, in any unit, and how far it is from the truth.
struct CostAndError {
  double cost = 0, error = 0;
};

/// Is `a` at least as good as `b` in cost and in error, and better in one of them?
inline bool dominates(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

/// Those that nothing dominates: less error is to be had only for more cost. Values that are not finite are none of
/// them.
/// @return positions, cheapest first
std::vector<std::size_t> paretoFront(std::span<const CostAndError> points);

/// p of error = c h^p: the slope of a line through the logarithms, by least squares.
/// @return nothing for fewer than two different h, or values that are not above 0
std::optional<double> orderOfConvergence(std::span<const double> h, std::span<const double> error);

}  // namespace umbrick
