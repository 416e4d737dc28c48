// SPDX-License-Identifier: Apache-2.0
#include "sweep/medium_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace umbrick {
namespace {

using Four = std::array<double, 4>;

Four numbersOf(const Medium& medium, double most) {
  const double sigma = std::min(medium.sigma_t, most);
  return {sigma, sigma * medium.albedo.r, sigma * medium.albedo.g, sigma * medium.albedo.b};
}

// Returns how many steps a 1D function needs: eight between its nearest control points, within bounds.
int stepsFor(const std::vector<double>& values) {
  double nearest = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) nearest = std::min(nearest, values[i] - values[i - 1]);
  if (!(nearest > 0)) return 16384;
  const double wanted = 8 * (values.back() - values.front()) / nearest;
  int steps = 16384;
  while (steps < 65536 && steps < wanted) steps *= 2;
  return steps;
}

// Tells whether a function has several colours and reaches an extinction.
bool hidesColours(const TransferFunction& transfer, double extinction) {
  const std::vector<Medium>& media = transfer.media();
  const auto largest = std::ranges::max_element(media, {}, &Medium::sigma_t);
  return largest->sigma_t >= extinction &&
         std::ranges::any_of(media, [&](const Medium& medium) { return medium.albedo != largest->albedo; });
}

// Integrates a 1D function from below: exactly, since sigma_t is linear and sigma_s quadratic between control points.
class MediumIntegral {
 public:
  MediumIntegral(const TransferFunction& transfer, double most) : transfer_(transfer), most_(most) {}
  // Returns the integral over the values [a, b] without control points in between.
  Four piece(double a, double b) const {
    // The rule of Gauss with two points is exact for cubic functions, and needs no values at the ends, where functions
    // jump.
    const double half = (b - a) / 2, place = half / std::sqrt(3.0);
    const Four p = at(a + half - place), q = at(a + half + place);
    Four sum;
    for (std::size_t i = 0; i < 4; ++i) sum[i] = half * (p[i] + q[i]);
    return sum;
  }
  Four at(double value) const { return numbersOf(transfer_(value), most_); }

 private:
  const TransferFunction& transfer_;
  double most_;
};

}  // namespace

MediumTable::MediumTable(const TransferFunction& transfer, double exact, double most, double hiding) {
  const std::vector<double>& values = transfer.values();
  const double low = values.front(), high = values.back();
  // A function of a single step has no extent.
  const double extent = std::max(high - low, 1e-3 * std::max(std::abs(low), std::abs(high)) + 1e-30);
  steps_ = transfer.is2d() ? 1024 : stepsFor(values);
  constexpr int kEnds = 4;  // steps before the first control point and behind the last
  perUnit_ = (steps_ - 2 * kEnds - 1) / extent;
  origin_ = low;
  first_ = kEnds;
  if (exact > low && exact <= high) {
    origin_ = exact;
    first_ = std::round((exact - low) * perUnit_) + kEnds;
  }
  if (transfer.is2d())
    fill2d(transfer, most);
  else
    fill1d(transfer, most);
  if (!transfer.is2d() && hidesColours(transfer, hiding))
    stretches_ = StretchTable(
        transfer, [this](double value) { return stepsOf(value); }, steps_, most);
}

void MediumTable::fill1d(const TransferFunction& transfer, double most) {
  const auto entries = static_cast<std::size_t>(steps_) + 1;
  points_.resize(4 * entries);
  sums_.resize(4 * entries);
  counts_.assign(2 * entries + 1, 0);
  const MediumIntegral integral(transfer, most);
  const auto valueOf = [&](int step) { return origin_ + (step - first_) / perUnit_; };
  std::vector<Four> sums(entries, Four{});
  auto next = transfer.values().begin();
  for (int step = 0; step <= steps_; ++step) {
    const auto i = static_cast<std::size_t>(step);
    const double value = valueOf(step);
    const Four point = integral.at(value);
    for (std::size_t c = 0; c < 4; ++c) points_[4 * i + c] = static_cast<float>(point[c]);
    if (step == 0) continue;
    Four sum{};
    double from = valueOf(step - 1);
    next = std::upper_bound(next, transfer.values().end(), from);
    for (auto control = next; from < value; ++control) {
      const double to = control != transfer.values().end() && *control < value ? *control : value;
      if (to > from) {
        const Four part = integral.piece(from, to);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += std::max(part[c], 0.0) * perUnit_;
      }
      from = to;
    }
    for (std::size_t c = 0; c < 4; ++c) sums[i][c] = sums[i - 1][c] + sum[c];
  }
  const double whole = sums.back()[0];
  sumUnit_ = static_cast<float>(whole > 0 ? whole / 2147483000.0 : 1);
  double least = whole, largest = 0;
  for (std::size_t i = 0; i < entries; ++i)
    if (points_[4 * i] > 0) {
      least = std::min<double>(least, points_[4 * i]);
      largest = std::max<double>(largest, points_[4 * i]);
    }
  const bool fine = largest > 1e3 * least;
  if (fine) rests_.resize(4 * entries);
  for (std::size_t i = 0; i < entries; ++i)
    for (std::size_t c = 0; c < 4; ++c) {
      const double sum = std::min(sums[i][c] / sumUnit_, 2147483600.0);
      const double units = fine ? std::floor(sum) : std::round(sum);
      sums_[4 * i + c] = static_cast<std::int32_t>(units);
      if (fine) rests_[4 * i + c] = static_cast<std::int32_t>(std::lround((sum - units) * kRests));
    }
  for (std::size_t i = 0; i < entries; ++i) {
    const bool way = i + 1 < entries && sums[i + 1][0] > sums[i][0];
    counts_[2 * i + 1] = counts_[2 * i] + (points_[4 * i] > 0);
    counts_[2 * i + 2] = counts_[2 * i + 1] + way;
  }
}

void MediumTable::fill2d(const TransferFunction& transfer, double most) {
  gradientSteps_ = 255;
  const Range gradients = transfer.gradientDomain();
  gradientOrigin_ = gradients.min;
  gradientPerUnit_ = gradientSteps_ / std::max(static_cast<double>(gradients.max) - gradients.min, 1e-30);
  const auto width = static_cast<std::size_t>(steps_) + 1;
  points_.resize(4 * width * static_cast<std::size_t>(gradientSteps_ + 1));
  counts_.assign(static_cast<std::size_t>(steps_ + 2) * static_cast<std::size_t>(gradientSteps_ + 2), 0);
  const auto at = [&](int v, int g) { return countAt(v, g); };
  for (int g = 0; g <= gradientSteps_; ++g)
    for (int v = 0; v <= steps_; ++v) {
      const Four point =
          numbersOf(transfer(origin_ + (v - first_) / perUnit_, gradientOrigin_ + g / gradientPerUnit_), most);
      const std::size_t i = static_cast<std::size_t>(g) * width + static_cast<std::size_t>(v);
      for (std::size_t c = 0; c < 4; ++c) points_[4 * i + c] = static_cast<float>(point[c]);
      counts_[at(v + 1, g + 1)] =
          counts_[at(v, g + 1)] + counts_[at(v + 1, g)] - counts_[at(v, g)] + (points_[4 * i] > 0);
    }
}

bool MediumTable::isTransparent(const Range& value, const Range& gradient) const {
  const auto clamped = [](double steps, int most) { return std::clamp(steps, 0.0, static_cast<double>(most)); };
  const double low = clamped(stepsOf(value.min), steps_), high = clamped(stepsOf(value.max), steps_);
  const double lowStep = std::floor(low), highStep = std::floor(high);
  if (!is2d()) {
    // Entries are steps and the ways behind them, in turn.
    const auto begin = static_cast<std::size_t>(2 * lowStep + (low > lowStep));
    const auto end = static_cast<std::size_t>(2 * highStep + (high > highStep));
    return counts_[end + 1] == counts_[begin];
  }
  const auto below = static_cast<int>(std::floor(clamped(gradientStepsOf(gradient.min), gradientSteps_)));
  const auto above = static_cast<int>(std::ceil(clamped(gradientStepsOf(gradient.max), gradientSteps_)));
  const auto first = static_cast<int>(lowStep), last = static_cast<int>(std::ceil(high));
  return counts_[countAt(last + 1, above + 1)] - counts_[countAt(first, above + 1)] -
             counts_[countAt(last + 1, below)] + counts_[countAt(first, below)] ==
         0;
}

}  // namespace umbrick
