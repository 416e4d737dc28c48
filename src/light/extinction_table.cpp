// SPDX-License-Identifier: Apache-2.0
#include "umbrick/light/extinction_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace umbrick {
namespace {

/// The integral of sigma_t of a 1D function, from its first control point on.
class Integral {
 public:
  explicit Integral(const TransferFunction& transfer) : transfer_(transfer) {
    for (std::size_t i = 0; i < values().size(); ++i)
      sums_.push_back(i == 0 ? 0
                             : sums_.back() + 0.5 * (values()[i] - values()[i - 1]) * (sigma_t(i) + sigma_t(i - 1)));
  }
  double operator()(double value) const {
    const auto next = std::upper_bound(values().begin(), values().end(), value);
    if (next == values().begin()) return sigma_t(0) * (value - values().front());
    const auto i = static_cast<std::size_t>(next - values().begin()) - 1;
    const double beyond = value - values()[i];
    if (next == values().end()) return sums_[i] + sigma_t(i) * beyond;
    const double slope = (sigma_t(i + 1) - sigma_t(i)) / (values()[i + 1] - values()[i]);
    return sums_[i] + beyond * (sigma_t(i) + 0.5 * slope * beyond);
  }

 private:
  const std::vector<double>& values() const { return transfer_.values(); }
  double sigma_t(std::size_t i) const { return transfer_.media()[i].sigma_t; }
  const TransferFunction& transfer_;
  std::vector<double> sums_;
};

}  // namespace

ExtinctionTable::ExtinctionTable(const TransferFunction& transfer) : transfer_(transfer) {
  integrals_.resize(kSteps + 2);
  means_.resize(kSteps + 1);
  opaque_.resize(kSteps + 1);
  if (transfer.is2d()) {
    // The value is sigma_t itself, whose integral is half its square.
    double most = 0;
    for (const Medium& medium : transfer.media()) most = std::max(most, medium.sigma_t);
    perUnit_ = most > 0 ? kSteps / most : 1;
    for (int i = 0; i < kSteps + 2; ++i)
      integrals_[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * i * static_cast<double>(i) / perUnit_);
    for (int i = 0; i <= kSteps; ++i) {
      opaque_[static_cast<std::size_t>(i)] = i;
      means_[static_cast<std::size_t>(i)] = static_cast<float>((i + 0.5) / perUnit_);
    }
    above_ = static_cast<float>(most);
    findEmptyEnds();
    return;
  }
  // A function of a single step has no extent.
  const double low = transfer.values().front(), high = transfer.values().back();
  const double extent = std::max(high - low, 1e-3 * std::max(std::abs(low), std::abs(high)) + 1e-20);
  low_ = low;
  perUnit_ = (kSteps - 2 * kEnds) / extent;
  const double first = low - kEnds / perUnit_;
  const Integral integral(transfer);
  for (int i = 0; i < kSteps + 2; ++i) {
    const double value = low + (i - kEnds) / perUnit_;
    const double sum = integral(value);
    integrals_[static_cast<std::size_t>(i)] = static_cast<float>((sum - integral(first)) * perUnit_);
    // Of single precision the difference of two sums would have left few digits.
    if (i <= kSteps)
      means_[static_cast<std::size_t>(i)] = static_cast<float>((integral(value + 1 / perUnit_) - sum) * perUnit_);
    if (i == 0 || i > kSteps) continue;
    const bool empty = integrals_[static_cast<std::size_t>(i)] == integrals_[static_cast<std::size_t>(i) - 1];
    opaque_[static_cast<std::size_t>(i)] = opaque_[static_cast<std::size_t>(i) - 1] + !empty;
  }
  below_ = static_cast<float>(transfer.media().front().sigma_t);
  above_ = static_cast<float>(transfer.media().back().sigma_t);
  findEmptyEnds();
}

void ExtinctionTable::toSteps(std::span<float> values, std::span<const float> gradients) const {
  if (transfer_.is2d()) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = stepsOf(values[i], gradients[i]);
    return;
  }
  const double low = low_, perUnit = perUnit_;
  for (float& value : values) value = static_cast<float>(kEnds + (static_cast<double>(value) - low) * perUnit);
}

// Steps that no value has: of a function of a single point they are very many.
constexpr float kAnything = std::numeric_limits<float>::max();

void ExtinctionTable::findEmptyEnds() {
  // Where nothing is seen at all, the first end takes all values.
  if (opaque_.back() == 0 && below_ == 0 && above_ == 0) {
    emptyBelow_ = kAnything;
    emptyAbove_ = kAnything;
    return;
  }
  const auto first = std::ranges::upper_bound(opaque_, 0), last = std::ranges::lower_bound(opaque_, opaque_.back());
  emptyBelow_ = below_ > 0 ? -kAnything : static_cast<float>(first - opaque_.begin() - 1);
  emptyAbove_ = above_ > 0 ? kAnything : static_cast<float>(last - opaque_.begin());
  if (transfer_.is2d()) return;
  // The value of a step belongs to what is above it.
  const auto hasExtinction = [&](float steps) {
    return transfer_(low_ + (static_cast<double>(steps) - kEnds) / perUnit_).sigma_t > 0;
  };
  if (below_ == 0 && hasExtinction(emptyBelow_)) emptyBelow_ = std::nextafter(emptyBelow_, -1.0f);
  if (above_ == 0 && hasExtinction(emptyAbove_)) emptyAbove_ = std::nextafter(emptyAbove_, 2.0f * kSteps);
}

}  // namespace umbrick
