// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

std::string print(double number) {
  std::string text = std::to_string(number);
  if (text.find('.') != std::string::npos) text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

// A place on an axis, between nodes `lower` and `upper`, with the weight of the upper one. Beyond the ends the function
// is constant, and at a step this is its upper side.
struct Place {
  std::size_t lower = 0, upper = 0;
  double weight = 0;
};

Place locate(const std::vector<double>& axis, double at) {
  const auto above = std::upper_bound(axis.begin(), axis.end(), at);
  const auto upper = static_cast<std::size_t>(above - axis.begin());
  if (upper == 0) return {0, 0, 0};
  if (upper == axis.size()) return {upper - 1, upper - 1, 0};
  const double below = axis[upper - 1];
  return {upper - 1, upper, (at - below) / (axis[upper] - below)};
}

// Returns all places where a function that is linear between nodes can have its maximum over [low, high]: the ends, and
// the nodes between them with both sides of each step. At `low` a step has only its upper side.
std::vector<Place> extremes(const std::vector<double>& axis, double low, double high) {
  if (axis.empty()) return {Place{}};
  std::vector<Place> places{locate(axis, low), locate(axis, high)};
  for (auto node = std::upper_bound(axis.begin(), axis.end(), low); node != axis.end() && *node <= high; ++node) {
    const auto index = static_cast<std::size_t>(node - axis.begin());
    places.push_back({index, index, 0});
  }
  return places;
}

// Returns the largest of the leaves [first, last) of a tree that findMaxima makes.
double largestOf(const std::vector<double>& tree, std::size_t first, std::size_t last) {
  double largest = 0;
  const std::size_t leaves = tree.size() / 2;
  for (first += leaves, last += leaves; first < last; first /= 2, last /= 2) {
    if (first % 2 == 1) largest = std::max(largest, tree[first++]);
    if (last % 2 == 1) largest = std::max(largest, tree[--last]);
  }
  return largest;
}

double mix(double a, double b, double weight) { return a + (b - a) * weight; }
Medium mix(const Medium& a, const Medium& b, double weight) {
  return {a.albedo + (b.albedo - a.albedo) * weight, mix(a.sigma_t, b.sigma_t, weight)};
}

void checkAxis(const std::vector<double>& axis, const char* name) {
  if (axis.empty()) throw InvalidArgument(std::string("transfer function: no ") + name + "s");
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!std::isfinite(axis[i]))
      throw InvalidArgument(std::string("transfer function: ") + name + " " + std::to_string(i) + " is not finite");
    if (i > 0 && axis[i] < axis[i - 1])
      throw InvalidArgument(std::string("transfer function: ") + name + "s must ascend, but " + print(axis[i]) +
                            " follows " + print(axis[i - 1]));
  }
}

void checkMedium(const Medium& medium, std::size_t index) {
  const std::string at = "transfer function: point " + std::to_string(index) + ": ";
  for (int c = 0; c < 3; ++c)
    if (!(medium.albedo[c] >= 0 && medium.albedo[c] <= 1))
      throw InvalidArgument(at + "albedo is " + print(medium.albedo[c]) + ", must be in [0, 1]");
  if (!(medium.sigma_t >= 0 && std::isfinite(medium.sigma_t)))
    throw InvalidArgument(at + "sigma_t is " + print(medium.sigma_t) + ", must be 0 or more and finite");
}

// Returns the nodes that count: of several equal ones the first and the last.
std::vector<std::size_t> nodesThatCount(const std::vector<double>& axis) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (i == 0 || i + 1 == axis.size() || axis[i - 1] != axis[i] || axis[i] != axis[i + 1]) kept.push_back(i);
  return kept;
}

// Returns the ends of an axis rounded outwards, so that the range contains every control point.
Range domain(const std::vector<double>& axis) {
  if (axis.empty()) return {0, 0};
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Range range{static_cast<float>(axis.front()), static_cast<float>(axis.back())};
  if (range.min > axis.front()) range.min = std::nextafter(range.min, -kInfinity);
  if (range.max < axis.back()) range.max = std::nextafter(range.max, kInfinity);
  return range;
}

}  // namespace

TransferFunction::TransferFunction(std::vector<Point> points) {
  std::vector<double> values;
  for (const Point& point : points) values.push_back(point.value);
  checkAxis(values, "value");
  for (std::size_t i = 0; i < points.size(); ++i) checkMedium(points[i].medium, i);
  for (const std::size_t i : nodesThatCount(values)) {
    values_.push_back(values[i]);
    media_.push_back(points[i].medium);
  }
  findMaxima();
}

// A parent is the larger of its two children, node i of nodes 2 i and 2 i + 1. So the majorant of a function of a
// million points takes some twenty steps, whatever the range.
void TransferFunction::findMaxima() {
  const std::size_t leaves = media_.size();
  maxima_.resize(2 * leaves);
  for (std::size_t i = 0; i < leaves; ++i) maxima_[leaves + i] = media_[i].sigma_t;
  for (std::size_t i = leaves; i-- > 1;) maxima_[i] = std::max(maxima_[2 * i], maxima_[2 * i + 1]);
}

TransferFunction::TransferFunction(std::vector<double> values, std::vector<double> gradients,
                                   std::vector<Medium> media) {
  checkAxis(values, "value");
  checkAxis(gradients, "gradient");
  if (media.size() != values.size() * gradients.size())
    throw InvalidArgument("transfer function: expected " + std::to_string(values.size()) + " x " +
                          std::to_string(gradients.size()) + " media, found " + std::to_string(media.size()));
  for (std::size_t i = 0; i < media.size(); ++i) checkMedium(media[i], i);
  const std::vector<std::size_t> columns = nodesThatCount(values), rows = nodesThatCount(gradients);
  for (const std::size_t i : columns) values_.push_back(values[i]);
  for (const std::size_t j : rows) {
    gradients_.push_back(gradients[j]);
    for (const std::size_t i : columns) media_.push_back(media[j * values.size() + i]);
  }
}

Medium TransferFunction::operator()(double value, double gradient) const {
  if (std::isnan(value) || (is2d() && std::isnan(gradient))) return {};
  const Place v = locate(values_, value);
  const Place g = is2d() ? locate(gradients_, gradient) : Place{};
  const auto row = [&](std::size_t j) {
    const Medium* media = media_.data() + j * values_.size();
    return mix(media[v.lower], media[v.upper], v.weight);
  };
  return g.lower == g.upper ? row(g.lower) : mix(row(g.lower), row(g.upper), g.weight);
}

Range TransferFunction::valueDomain() const { return domain(values_); }
Range TransferFunction::gradientDomain() const { return domain(gradients_); }

bool TransferFunction::isTransparent(const Range& value, const Range& gradient) const {
  return majorant(value, gradient) == 0;
}

double TransferFunction::majorant(const Range& value, const Range& gradient) const {
  if (value.empty() || (is2d() && gradient.empty())) return 0;
  if (!is2d()) {
    // The function is linear between points: its maximum is at an end of the range, or at a point between.
    const auto first = std::upper_bound(values_.begin(), values_.end(), double(value.min)) - values_.begin();
    const auto last = std::upper_bound(values_.begin(), values_.end(), double(value.max)) - values_.begin();
    const double ends = std::max((*this)(value.min).sigma_t, (*this)(value.max).sigma_t);
    return std::max(ends, largestOf(maxima_, static_cast<std::size_t>(first), static_cast<std::size_t>(last)));
  }
  // The function is bilinear in each cell, so its maximum is at a corner of a cell or of the ranges.
  const std::vector<Place> rows = extremes(gradients_, gradient.min, gradient.max);
  double largest = 0;
  for (const Place& v : extremes(values_, value.min, value.max))
    for (const Place& g : rows) {
      const auto row = [&](std::size_t j) {
        const Medium* media = media_.data() + j * values_.size();
        return mix(media[v.lower].sigma_t, media[v.upper].sigma_t, v.weight);
      };
      largest = std::max(largest, mix(row(g.lower), row(g.upper), g.weight));
    }
  return largest;
}

TransferFunction TransferFunction::windowed(double low, double high) const {
  if (!(low < high) || !std::isfinite(low) || !std::isfinite(high) || !std::isfinite(high - low))
    throw InvalidArgument("transfer function: the window is [" + print(low) + ", " + print(high) +
                          "], must be two finite numbers that ascend");
  TransferFunction stretched = *this;
  const double first = values_.front(), extent = values_.back() - first;
  for (double& value : stretched.values_) {
    const double share = extent > 0 ? (value - first) / extent : 0.5;
    value = share < 1 ? low + share * (high - low) : high;
  }
  stretched.unit_.clear();
  return stretched;
}

TransferFunction TransferFunction::withUnit(std::string unit) const {
  TransferFunction result = *this;
  result.unit_ = std::move(unit);
  return result;
}

TransferFunction TransferFunction::shifted(double offset) const {
  TransferFunction result = *this;
  for (double& value : result.values_) value += offset;
  checkAxis(result.values_, "value");
  return result;
}

TransferFunction TransferFunction::scaled(double factor) const {
  if (!(factor >= 0 && std::isfinite(factor)))
    throw InvalidArgument("transfer function: the sigma scale is " + print(factor) + ", must be 0 or more and finite");
  TransferFunction result = *this;
  for (std::size_t i = 0; i < media_.size(); ++i) {
    result.media_[i].sigma_t *= factor;
    checkMedium(result.media_[i], i);
  }
  if (!is2d()) result.findMaxima();
  return result;
}

}  // namespace umbrick
