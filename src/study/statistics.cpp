// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/statistics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) throw InvalidArgument("spread: no values");
  std::sort(values.begin(), values.end());
  return {values.front(), quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75), values.back()};
}

std::vector<double> ratios(std::span<const double> numerators, std::span<const double> denominators) {
  if (numerators.size() != denominators.size())
    throw InvalidArgument("ratios: " + std::to_string(numerators.size()) + " values over " +
                          std::to_string(denominators.size()));
  std::vector<double> quotients(numerators.size());
  std::transform(numerators.begin(), numerators.end(), denominators.begin(), quotients.begin(),
                 [](double a, double b) { return a / b; });
  return quotients;
}

std::vector<std::size_t> paretoFront(std::span<const CostAndError> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const CostAndError &p = points[a], &q = points[b];
    if (p.cost != q.cost) return p.cost < q.cost;
    return p.error != q.error ? p.error < q.error : a < b;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    // Every point that is cheaper, or as cheap and better, comes before this one: only the last of the front
    // can dominate it.
    if (front.empty() || !dominates(points[front.back()], points[i])) front.push_back(i);
  return front;
}

std::optional<double> orderOfConvergence(std::span<const double> h, std::span<const double> error) {
  if (h.size() != error.size()) throw InvalidArgument("order of convergence: lists of different length");
  double meanX = 0, meanY = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (!(h[i] > 0 && error[i] > 0)) return std::nullopt;
    meanX += std::log(h[i]);
    meanY += std::log(error[i]);
  }
  const double count = static_cast<double>(h.size());
  meanX /= count;
  meanY /= count;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double x = std::log(h[i]) - meanX;
    xx += x * x;
    xy += x * (std::log(error[i]) - meanY);
  }
  if (!(xx > 1e-12)) return std::nullopt;
  return xy / xx;
}

}  // namespace umbrick
