#include "umbrick/optics/transfer_table.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

glm::dvec4 coefficients(const Medium& medium) { return {medium.sigma_s(), medium.sigma_t}; }

double nodeAt(const Range& range, int nodes, int index) {
  const double low = range.min, high = range.max;
  return index == nodes - 1 ? high : low + (high - low) * index / (nodes - 1);
}

// At least one bin of some width, with `range.min` at a node.
Range withExtent(const Range& range) {
  if (range.min < range.max) return range;
  const float least = std::max(std::abs(range.min) * 0x1p-10f, 0x1p-60f);
  return {range.min, range.min + least};
}

// The part of `data` where the function varies. Beyond its ends the function is what it is at its ends, except for a
// step there, which needs a bin of its own.
Range coveredRange(const Range& data, const std::vector<double>& axis, const Range& domain, int nodes) {
  const float bin =
      (domain.extent() > 0 ? std::min(domain.extent(), data.extent()) : data.extent()) / static_cast<float>(nodes - 1);
  Range varying = domain;
  if (axis.size() > 1 && axis[0] == axis[1]) varying.min -= bin;
  if (axis.size() > 1 && axis[axis.size() - 2] == axis.back()) varying.max += bin;
  const Range covered{std::max(data.min, varying.min), std::min(data.max, varying.max)};
  return covered.empty() ? withExtent({data.min, data.min}) : withExtent(covered);
}

Range aroundNode(const Range& range, int nodes, int index) {
  const auto halfBin = static_cast<float>((static_cast<double>(range.max) - range.min) / (2.0 * (nodes - 1)));
  const auto at = static_cast<float>(nodeAt(range, nodes, index));
  // Rounding must not leave a gap between neighbours, and a step at the first node has a side below it.
  const float slack = 4 * std::numeric_limits<float>::epsilon() * std::max(std::abs(range.min), std::abs(range.max));
  return {std::max(range.min, at - halfBin) - slack, std::min(range.max, at + halfBin) + slack};
}

// First and last entry that a lookup in `looked` can touch, widened by one.
std::pair<int, int> touched(const Range& looked, const Range& range, int nodes) {
  const double perValue = (nodes - 1) / (static_cast<double>(range.max) - range.min);
  const auto entry = [&](double at) { return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(nodes - 1))); };
  return {entry(std::floor((static_cast<double>(looked.min) - range.min) * perValue) - 1),
          entry(std::ceil((static_cast<double>(looked.max) - range.min) * perValue) + 1)};
}

// Mean of the function over [low, high], exactly: between control points sigma_t is linear and sigma_s quadratic, which
// Simpson's rule integrates without error. `next` is the first control point above `low`.
glm::dvec4 meanOver(const TransferFunction& transfer, double low, double high, std::size_t next) {
  const std::vector<double>& values = transfer.values();
  const std::vector<Medium>& media = transfer.media();
  // The medium on one side of a place between control points `next` - 1 and `next`.
  const auto at = [&](double value) -> Medium {
    if (next == 0) return media.front();
    if (next == values.size()) return media.back();
    const Medium &below = media[next - 1], &above = media[next];
    const double t = (value - values[next - 1]) / (values[next] - values[next - 1]);
    return {below.albedo + (above.albedo - below.albedo) * t, below.sigma_t + (above.sigma_t - below.sigma_t) * t};
  };
  glm::dvec4 sum{0};
  for (double from = low; from < high; ++next) {
    const double to = next < values.size() ? std::min(values[next], high) : high;
    if (!(from < to)) continue;  // the two sides of a step
    sum += (coefficients(at(from)) + 4.0 * coefficients(at(0.5 * (from + to))) + coefficients(at(to))) *
           ((to - from) / (6 * (high - low)));
    from = to;
  }
  return sum;
}

// The function at a value, at a step the average of both sides.
glm::dvec4 bothSides(const TransferFunction& transfer, double value) {
  const auto [first, last] = std::equal_range(transfer.values().begin(), transfer.values().end(), value);
  const Medium* media = transfer.media().data();
  if (last - first < 2) return coefficients(transfer(value));
  return 0.5 * (coefficients(media[first - transfer.values().begin()]) +
                coefficients(media[last - transfer.values().begin() - 1]));
}

}  // namespace

bool TransferTable::isTransparent(const Range& values, const Range& gradients) const {
  if (values.empty() || (rows > 1 && gradients.empty())) return true;
  const auto [left, right] = touched(values, value, columns);
  const auto [bottom, top] = rows > 1 ? touched(gradients, gradient, rows) : std::pair(0, 0);
  const auto before = [&](int i, int j) {
    return opaqueBefore[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns + 1) +
                        static_cast<std::size_t>(i)];
  };
  return before(right + 1, top + 1) - before(left, top + 1) - before(right + 1, bottom) + before(left, bottom) == 0;
}

TransferTable sampleTransferFunction(const TransferFunction& transfer, const Range& value, const Range& gradient,
                                     int columns, int rows, TableCover cover) {
  if (columns < 2) throw InvalidArgument("transfer table: columns is " + std::to_string(columns) + ", must be above 1");
  if (rows < (transfer.is2d() ? 2 : 1))
    throw InvalidArgument("transfer table: rows is " + std::to_string(rows) + ", must be above " +
                          (transfer.is2d() ? "1" : "0"));
  if (value.empty() || (transfer.is2d() && gradient.empty()))
    throw InvalidArgument("transfer table: the range of the data is empty");
  for (const float end : {value.min, value.max, transfer.is2d() ? gradient.min : 0, transfer.is2d() ? gradient.max : 0})
    if (!std::isfinite(end)) throw InvalidArgument("transfer table: the range of the data is not finite");
  TransferTable table;
  table.columns = columns;
  table.rows = transfer.is2d() ? rows : 1;
  const auto covered = [&](const Range& data, const std::vector<double>& axis, const Range& domain, int nodes) {
    return cover == TableCover::data ? withExtent(data) : coveredRange(data, axis, domain, nodes);
  };
  table.value = covered(value, transfer.values(), transfer.valueDomain(), columns);
  table.gradient =
      transfer.is2d() ? covered(gradient, transfer.gradients(), transfer.gradientDomain(), rows) : Range{0, 0};

  const auto stride = static_cast<std::size_t>(columns);
  table.entries.resize(stride * static_cast<std::size_t>(table.rows));
  table.opaqueBefore.assign((stride + 1) * static_cast<std::size_t>(table.rows + 1), 0);
  for (int j = 0; j < table.rows; ++j) {
    const double atGradient = table.rows > 1 ? nodeAt(table.gradient, table.rows, j) : 0;
    const Range nearGradient = table.rows > 1 ? aroundNode(table.gradient, table.rows, j) : Range{0, 0};
    glm::vec4* entries = table.entries.data() + static_cast<std::size_t>(j) * stride;
    int* below = table.opaqueBefore.data() + static_cast<std::size_t>(j) * (stride + 1);
    int* before = below + stride + 1;
    int opaqueInRow = 0;
    for (int i = 0; i < columns; ++i) {
      entries[i] = glm::vec4(coefficients(transfer(nodeAt(table.value, columns, i), atGradient)));
      const bool opaque =
          entries[i].a > 0 || !transfer.isTransparent(aroundNode(table.value, columns, i), nearGradient);
      opaqueInRow += opaque ? 1 : 0;
      before[i + 1] = below[i + 1] + opaqueInRow;
    }
  }
  return table;
}

namespace {

// (1 - exp(-x)) / x in double precision; slab.glsl has it in single.
double slabFactor(double x) { return x > 0 ? -std::expm1(-x) / x : 1; }

// A slab with media in equal layers from front to back: what a slab of constant medium would have to scatter per length
// to send the same light to the eye. Two at once, seen from either side.
class LayeredSlab {
 public:
  // More layers than this are joined: a layer of mean medium then spans 1/64 of the slab.
  static constexpr std::size_t kLayers = 64;

  LayeredSlab(const glm::dvec4* binMeans, std::size_t bins, double thickness) : thickness_(thickness) {
    const std::size_t perLayer = (bins + kLayers - 1) / kLayers;
    for (std::size_t bin = 0; bin < bins; bin += perLayer) {
      const std::size_t joined = std::min(perLayer, bins - bin);
      glm::dvec4 sum{0};
      for (std::size_t k = 0; k < joined; ++k) sum += binMeans[bin + k];
      Layer& layer = layers_[count_++];
      const double length = thickness * static_cast<double>(joined) / static_cast<double>(bins);
      const double tau = sum.a / static_cast<double>(joined) * length;
      layer.scattered = glm::dvec3(sum) / static_cast<double>(joined) * (length * slabFactor(tau));
      layer.transmittance = std::exp(-tau);
      tau_ += tau;
    }
  }

  glm::dvec3 fromFront() const {
    glm::dvec3 light{0};
    for (std::size_t i = count_; i-- > 0;) light = layers_[i].scattered + layers_[i].transmittance * light;
    return perLength(light);
  }
  glm::dvec3 fromBack() const {
    glm::dvec3 light{0};
    for (std::size_t i = 0; i < count_; ++i) light = layers_[i].scattered + layers_[i].transmittance * light;
    return perLength(light);
  }

 private:
  struct Layer {
    glm::dvec3 scattered;  // to the front or back of the layer, for light of radiance 1
    double transmittance;
  };
  glm::dvec3 perLength(const glm::dvec3& light) const { return light / (thickness_ * slabFactor(tau_)); }

  double thickness_, tau_ = 0;
  std::size_t count_ = 0;
  std::array<Layer, kLayers> layers_;
};

}  // namespace

std::vector<glm::vec4> preintegrate(const TransferFunction& transfer, const Range& value, int nodes, double thickness) {
  if (transfer.is2d()) throw InvalidArgument("preintegration: only a 1D transfer function has intervals of values");
  if (nodes < 2) throw InvalidArgument("preintegration: nodes is " + std::to_string(nodes) + ", must be above 1");
  if (!(value.min < value.max) || !std::isfinite(value.min) || !std::isfinite(value.max))
    throw InvalidArgument("preintegration: the range of values must be finite and have an extent");
  if (!(thickness >= 0) || !std::isfinite(thickness))
    throw InvalidArgument("preintegration: thickness is " + std::to_string(thickness) + ", must be 0 or more");
  const auto n = static_cast<std::size_t>(nodes);
  std::vector<glm::dvec4> binMeans(n - 1);
  for (int i = 0; i + 1 < nodes; ++i) {
    const double low = nodeAt(value, nodes, i), high = nodeAt(value, nodes, i + 1);
    const auto next = std::upper_bound(transfer.values().begin(), transfer.values().end(), low);
    binMeans[static_cast<std::size_t>(i)] =
        meanOver(transfer, low, high, static_cast<std::size_t>(next - transfer.values().begin()));
  }
  // Bins are equal, so a mean over several is the mean of theirs. Each row adds its own bins up instead of subtracting
  // prefix sums: terms are not negative, nothing cancels, and what is 0 in all bins is 0 exactly.
  std::vector<glm::vec4> means(n * n);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 16), [&](const tbb::blocked_range<std::size_t>& rows) {
    for (std::size_t i = rows.begin(); i < rows.end(); ++i) {
      means[i * n + i] = glm::vec4(bothSides(transfer, nodeAt(value, nodes, static_cast<int>(i))));
      glm::dvec4 sum{0};
      for (std::size_t j = i + 1; j < n; ++j) {
        sum += binMeans[j - 1];
        // Front value fastest: (i in front, j behind) is in row j.
        means[i * n + j] = means[j * n + i] = glm::vec4(sum / static_cast<double>(j - i));
        if (thickness == 0) continue;
        const LayeredSlab slab(&binMeans[i], j - i, thickness);
        const glm::vec3 front(slab.fromFront()), back(slab.fromBack());
        means[j * n + i] = glm::vec4(front, means[j * n + i].a);
        means[i * n + j] = glm::vec4(back, means[i * n + j].a);
      }
    }
  });
  return means;
}

}  // namespace umbrick
