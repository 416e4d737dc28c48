// SPDX-License-Identifier: Apache-2.0
#include "sweep/medium_table.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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

// Returns how many steps an axis needs: eight between its nearest control points, within bounds.
int stepsFor(const std::vector<double>& values, int least, int most) {
  double nearest = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) nearest = std::min(nearest, values[i] - values[i - 1]);
  if (!(nearest > 0)) return least;
  const double wanted = 8 * (values.back() - values.front()) / nearest;
  int steps = least;
  while (steps < most && steps < wanted) steps *= 2;
  return steps;
}

// Tells whether a function has several colours and reaches an extinction.
bool hidesColours(const TransferFunction& transfer, double extinction) {
  const std::vector<Medium>& media = transfer.media();
  const auto largest = std::ranges::max_element(media, {}, &Medium::sigma_t);
  return largest->sigma_t >= extinction &&
         std::ranges::any_of(media, [&](const Medium& medium) { return medium.albedo != largest->albedo; });
}

// Integrates a function over the value, of a 2D one for one gradient: exactly, since sigma_t is linear and sigma_s
// quadratic between control points.
class MediumIntegral {
 public:
  MediumIntegral(const TransferFunction& transfer, double most, double gradient = 0)
      : transfer_(transfer), most_(most), gradient_(gradient) {}
  Four between(double from, double to) const {
    const std::vector<double>& controls = transfer_.values();
    Four sum{};
    for (auto control = std::ranges::upper_bound(controls, from); from < to; ++control) {
      const double end = control != controls.end() && *control < to ? *control : to;
      if (end > from) {
        const Four part = piece(from, end);
        for (std::size_t i = 0; i < 4; ++i) sum[i] += part[i];
      }
      from = end;
    }
    return sum;
  }
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
  Four at(double value) const { return numbersOf(transfer_(value, gradient_), most_); }

 private:
  const TransferFunction& transfer_;
  double most_, gradient_;
};

}  // namespace

MediumTable::MediumTable(const TransferFunction& transfer, double exact, double most, double hiding) {
  const std::vector<double>& values = transfer.values();
  const double low = values.front(), high = values.back();
  // A function of a single step has no extent.
  const double extent = std::max(high - low, 1e-3 * std::max(std::abs(low), std::abs(high)) + 1e-30);
  if (transfer.is2d()) {
    // Gradients are looked up at steps; the value is integrated, so that its peaks may be narrower than a step.
    steps_ = 1024;
    gradientSteps_ = stepsFor(transfer.gradients(), 256, 2048) - 1;
  } else {
    steps_ = stepsFor(values, 16384, 65536);
  }
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
  for (int step = 0; step <= steps_; ++step) {
    const auto i = static_cast<std::size_t>(step);
    const double value = valueOf(step);
    const Four point = integral.at(value);
    for (std::size_t c = 0; c < 4; ++c) points_[4 * i + c] = static_cast<float>(point[c]);
    if (step == 0) continue;
    const Four way = integral.between(valueOf(step - 1), value);
    for (std::size_t c = 0; c < 4; ++c) sums[i][c] = sums[i - 1][c] + std::max(way[c], 0.0) * perUnit_;
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
  const Range gradients = transfer.gradientDomain();
  gradientOrigin_ = gradients.min;
  gradientPerUnit_ = gradientSteps_ / std::max(static_cast<double>(gradients.max) - gradients.min, 1e-30);
  const auto width = static_cast<std::size_t>(steps_) + 1, rows = static_cast<std::size_t>(gradientSteps_) + 1;
  points_.resize(4 * width * rows);
  sums_.resize(4 * width * rows);
  const auto valueOf = [&](int step) { return origin_ + (step - first_) / perUnit_; };
  // The integral of each row over the value, first in double precision.
  std::vector<Four> sums(width * rows);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows, 4), [&](const auto& range) {
    for (std::size_t row = range.begin(); row != range.end(); ++row) {
      const MediumIntegral integral(transfer, most, gradientOrigin_ + static_cast<double>(row) / gradientPerUnit_);
      for (int step = 0; step <= steps_; ++step) {
        const std::size_t i = row * width + static_cast<std::size_t>(step);
        const Four point = integral.at(valueOf(step));
        for (std::size_t c = 0; c < 4; ++c) points_[4 * i + c] = static_cast<float>(point[c]);
        sums[i] = {};
        if (step == 0) continue;
        const Four way = integral.between(valueOf(step - 1), valueOf(step));
        for (std::size_t c = 0; c < 4; ++c) sums[i][c] = sums[i - 1][c] + std::max(way[c], 0.0) * perUnit_;
      }
    }
  });
  double whole = 0;
  for (std::size_t row = 0; row < rows; ++row) whole = std::max(whole, sums[(row + 1) * width - 1][0]);
  sumUnit_ = static_cast<float>(whole > 0 ? whole / 2147483000.0 : 1);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      sums_[4 * i + c] = static_cast<std::int32_t>(std::lround(std::min(sums[i][c] / sumUnit_, 2147483600.0)));
  // Of the numbers of points and ways with medium, those to the left and above of each.
  const std::size_t columns = countAt(0, 1);
  counts_.assign(columns * (rows + 1), 0);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      const std::size_t i = row * width + column / 2;
      const bool way = column / 2 + 1 < width && sums[i + 1][0] > sums[i][0];
      const std::size_t at = (row + 1) * columns + column + 1;
      counts_[at] =
          counts_[at - 1] + counts_[at - columns] - counts_[at - columns - 1] + (column % 2 ? way : points_[4 * i] > 0);
    }
}

bool MediumTable::isTransparent(const Range& value, const Range& gradient) const {
  const auto clamped = [](double steps, int most) { return std::clamp(steps, 0.0, static_cast<double>(most)); };
  const double low = clamped(stepsOf(value.min), steps_), high = clamped(stepsOf(value.max), steps_);
  const double lowStep = std::floor(low), highStep = std::floor(high);
  // Entries are steps and the ways behind them, in turn.
  const auto begin = static_cast<int>(2 * lowStep + (low > lowStep));
  const auto end = static_cast<int>(2 * highStep + (high > highStep)) + 1;
  if (!is2d()) return counts_[static_cast<std::size_t>(end)] == counts_[static_cast<std::size_t>(begin)];
  const auto below = static_cast<int>(std::floor(clamped(gradientStepsOf(gradient.min), gradientSteps_)));
  const auto above = static_cast<int>(std::ceil(clamped(gradientStepsOf(gradient.max), gradientSteps_)));
  return counts_[countAt(end, above + 1)] - counts_[countAt(begin, above + 1)] - counts_[countAt(end, below)] +
             counts_[countAt(begin, below)] ==
         0;
}

}  // namespace umbrick
