// The transfer function along a cell of a ray, in pieces on which extinction is a polynomial.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "reference/cubic.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// One linear stretch of a 1D function: at value v, sigma_t and albedo are base + slope (v - origin).
struct LinearStretch {
  double origin = 0, sigma_t = 0, sigmaSlope = 0;
  glm::dvec3 albedo{0}, albedoSlope{0};
};

/// Integrals of a 1D function from its first control point on, over the value.
struct MediumIntegral {
  double sigma_t = 0;
  glm::dvec3 sigma_s{0};
};

/// The part [begin, end] of a cell, where s in [0, 1] is the place along the ray.
struct CellPiece {
  double begin = 0, end = 0;
  Cubic sigma_t;                           // in s; 1/world unit
  const LinearStretch* stretch = nullptr;  // of a 1D function; null for a 2D function
};

class Classifier {
 public:
  explicit Classifier(const TransferFunction& transfer);

  bool is2d() const { return transfer_.is2d(); }
  const TransferFunction& transfer() const { return transfer_; }

  /// Returns the stretch of a 1D function in which all of these values lie, if it is only one.
  std::optional<std::size_t> onlyStretch(const Range& values) const {
    if (is2d()) return std::nullopt;
    const std::size_t index = locate(values.min);
    return index == locate(values.max) ? std::optional(index) : std::nullopt;
  }
  const LinearStretch& stretch(std::size_t index) const { return stretches_[index]; }
  static CellPiece pieceOf(const LinearStretch& stretch, const Cubic& value, double begin, double end) {
    CellPiece piece{begin, end, {}, &stretch};
    for (std::size_t i = 0; i < 4; ++i) piece.sigma_t.c[i] = stretch.sigmaSlope * value.c[i];
    piece.sigma_t.c[0] = stretch.sigma_t + stretch.sigmaSlope * (value.c[0] - stretch.origin);
    return piece;
  }

  /// Calls visit(const CellPiece&) for the pieces of [0, 1] where the medium may scatter or absorb, in order.
  /// @param value,gradient  along the ray; the gradient matters for a 2D function only
  template <class Visit>
  void forEachPiece(const Cubic& value, const Cubic& gradient, const Visit& visit) const {
    if (is2d())
      forEachFitted(value, gradient, visit);
    else
      forEachExact(value, visit);
  }

  glm::dvec3 albedo(const CellPiece& piece, const Cubic& value, const Cubic& gradient, double s) const {
    if (!piece.stretch) return transfer_(value(s), gradient(s)).albedo;
    return piece.stretch->albedo + piece.stretch->albedoSlope * (value(s) - piece.stretch->origin);
  }

 private:
  // Returns the stretch that holds at a value. A step counts as its upper side.
  std::size_t locate(double value) const {
    return static_cast<std::size_t>(std::upper_bound(values_.begin(), values_.end(), value) - values_.begin());
  }

  template <class Visit>
  void visitStretch(const Cubic& value, std::size_t index, double begin, double end, const Visit& visit) const {
    const LinearStretch& stretch = stretches_[index];
    if (end <= begin || (stretch.sigma_t == 0 && stretch.sigmaSlope == 0)) return;
    visit(pieceOf(stretch, value, begin, end));
  }

  template <class Visit>
  void forEachExact(const Cubic& value, const Visit& visit) const {
    // Most cells lie between two points of the function. The control points of Bernstein's basis bound the cubic.
    const auto& c = value.c;
    const double b1 = c[0] + c[1] / 3, b2 = b1 + (c[1] + c[2]) / 3, b3 = c[0] + c[1] + c[2] + c[3];
    const std::size_t lowest = locate(std::min({c[0], b1, b2, b3}));
    if (lowest == values_.size() || std::max({c[0], b1, b2, b3}) < values_[lowest])
      return visitStretch(value, lowest, 0, 1, visit);
    // Other cells meet the points of the function one after the other between the turns of the cubic. Where the control
    // points are ordered, the cubic has no turn.
    if ((c[0] <= b1 && b1 <= b2 && b2 <= b3) || (c[0] >= b1 && b1 >= b2 && b2 >= b3))
      return forEachMonotonic(value, 0, 1, visit);
    std::array<double, 2> turns{};
    const int count = value.turns(turns);
    double begin = 0;
    for (int i = 0; i <= count; ++i) {
      const double end = i < count ? turns[static_cast<std::size_t>(i)] : 1;
      forEachMonotonic(value, begin, end, visit);
      begin = end;
    }
  }

  template <class Visit>
  void forEachMonotonic(const Cubic& value, double begin, double end, const Visit& visit) const {
    const double first = value(begin), last = value(end);
    std::size_t index = locate(first);
    const std::size_t target = locate(last);
    const std::size_t crossed = index < target ? target - index : index - target;
    if (crossed > kMostCrossed) return forEachMean(value, begin, end, visit);
    double at = begin;
    const auto crossTo = [&](double point, std::size_t next) {
      const double s = std::max(at, value.solve(point, begin, end));
      visitStretch(value, index, at, s, visit);
      at = s;
      index = next;
    };
    while (index < target) crossTo(values_[index], index + 1);
    while (index > target) crossTo(values_[index - 1], index - 1);
    visitStretch(value, index, at, end, visit);
  }

  // Where a part of a cell meets very many points, most of them lie closer together than any picture shows. It is cut
  // into as many equal parts, each with the mean of the function over the values that it runs through, as if it ran
  // through them evenly. The mean comes from integrals, so that it misses no point. Values bend by less
  // than 1 / kMostCrossed of their extent in a part. Where they turn, what lies at one value moves by half a part at
  // most.
  template <class Visit>
  void forEachMean(const Cubic& value, double begin, double end, const Visit& visit) const {
    double at = begin, from = value(begin);
    MediumIntegral low = integral(from);
    for (std::size_t i = 1; i <= kMostCrossed; ++i) {
      const double next = begin + (end - begin) * static_cast<double>(i) / static_cast<double>(kMostCrossed);
      const double to = value(next);
      const MediumIntegral high = integral(to);
      const double extent = to - from, sigma_t = extent != 0 ? (high.sigma_t - low.sigma_t) / extent : 0;
      if (sigma_t > 0 && next > at) {
        LinearStretch mean;
        mean.sigma_t = sigma_t;
        mean.albedo = glm::clamp((high.sigma_s - low.sigma_s) / (extent * sigma_t), 0.0, 1.0);
        visit(pieceOf(mean, value, at, next));
      }
      at = next;
      from = to;
      low = high;
    }
  }

  // Returns the integral from the first control point to a value.
  MediumIntegral integral(double value) const;

  // A 2D function is bilinear between lattice lines, so its extinction along a ray is of degree six there. It is
  // interpolated by a cubic in each quarter of the cell, or in what lattice lines leave of it. The cubic's four nodes
  // lie inside of a piece, where a step at one of its ends has only one side.
  template <class Visit>
  void forEachFitted(const Cubic& value, const Cubic& gradient, const Visit& visit) const {
    std::vector<double> cuts{0, 0.25, 0.5, 0.75, 1};
    addCrossings(value, transfer_.values(), cuts);
    addCrossings(gradient, transfer_.gradients(), cuts);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double begin = cuts[i], h = cuts[i + 1] - begin;
      if (!(h > 1e-12)) continue;
      std::array<double, 4> y;
      for (std::size_t k = 0; k < 4; ++k) {
        const double s = begin + h * (2 * static_cast<double>(k) + 1) / 8;
        y[k] = transfer_(value(s), std::max(0.0, gradient(s))).sigma_t;
      }
      if (y[0] == 0 && y[1] == 0 && y[2] == 0 && y[3] == 0) continue;
      visit(CellPiece{begin, begin + h, throughThirds(y, begin + h / 8, 0.75 * h), nullptr});
    }
  }

  // Appends the places in (0, 1) where a cubic takes one of the values of an axis.
  static void addCrossings(const Cubic& cubic, const std::vector<double>& axis, std::vector<double>& cuts) {
    std::array<double, 2> turns{};
    const int count = cubic.turns(turns);
    double begin = 0;
    for (int i = 0; i <= count; ++i) {
      const double end = i < count ? turns[static_cast<std::size_t>(i)] : 1;
      const double first = cubic(begin), last = cubic(end);
      const auto from = std::upper_bound(axis.begin(), axis.end(), std::min(first, last));
      const auto to = std::lower_bound(from, axis.end(), std::max(first, last));
      for (auto point = from; point != to; ++point) cuts.push_back(cubic.solve(*point, begin, end));
      begin = end;
    }
  }

  // Returns the cubic through the values y at `begin` and at one, two and three thirds of h behind it.
  static Cubic throughThirds(const std::array<double, 4>& y, double begin, double h);

  static constexpr std::size_t kMostCrossed = 512;

  TransferFunction transfer_;
  std::vector<double> values_;             // of the control points
  std::vector<LinearStretch> stretches_;   // below the first point, between neighbours, above the last point
  std::vector<MediumIntegral> integrals_;  // up to the lower end of each stretch; none where so many cannot be crossed
};

}  // namespace umbrick
