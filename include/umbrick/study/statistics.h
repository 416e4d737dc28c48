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

/// Returns the order statistics of values. Quantiles are linear between the values in order (type 7 of Hyndman
/// and Fan 1996).
/// @throw InvalidArgument  there are no values
Spread spreadOf(std::vector<double> values);

/// Returns each numerator over the denominator at its place. @throw InvalidArgument  the lists differ in length
std::vector<double> ratios(std::span<const double> numerators, std::span<const double> denominators);

/// The cost of a picture, in any unit, and its distance from the truth.
struct CostAndError {
  double cost = 0, error = 0;
};

/// Tells whether `a` is at least as good as `b` in cost and in error, and better in one of them.
inline bool dominates(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

/// Returns the points that no other point dominates: a smaller error than theirs costs more. Values that are not finite
/// are left out.
/// @return positions, cheapest first
std::vector<std::size_t> paretoFront(std::span<const CostAndError> points);

/// Returns p of error = c h^p: the slope of a line through the logarithms, by least squares.
/// @return nothing for fewer than two different h, or for values that are not above 0
std::optional<double> orderOfConvergence(std::span<const double> h, std::span<const double> error);

}  // namespace umbrick
