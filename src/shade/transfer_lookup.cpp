#include "shade/transfer_lookup.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include "umbrick/optics/transfer_table.h"

namespace umbrick {
namespace {

// Values this close are one to a driver: what is below the least normal number it may read as 0, and the inverse of
// their distance has to be a number.
constexpr double kLeastExtent = 0x1p-120;

// The function with an extinction that single precision can multiply by a slab's length, and divide by. What is cut off
// is opaque over any length that a number could tell from 0.
TransferFunction bounded(const TransferFunction& transfer, double spacing) {
  const double most = 1e30 / std::max(spacing, 1.0);
  std::vector<Medium> media = transfer.media();
  for (Medium& medium : media) medium.sigma_t = std::min(medium.sigma_t, most);
  if (transfer.is2d()) return {transfer.values(), transfer.gradients(), std::move(media)};
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < media.size(); ++i) points.push_back({transfer.values()[i], media[i]});
  return TransferFunction(std::move(points));
}

// The 1D function of the distance from `anchor` in steps: at whole numbers, which no rounding moves, where the table
// has its nodes.
TransferFunction inSteps(const TransferFunction& transfer, double anchor, double step) {
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < transfer.values().size(); ++i)
    points.push_back({std::clamp((transfer.values()[i] - anchor) / step, -1e300, 1e300), transfer.media()[i]});
  return TransferFunction(std::move(points));
}

}  // namespace

TransferLookup::Axis TransferLookup::makeAxis(const Range& values, double anchor, int nodes) {
  const double low = std::min<double>(values.min, anchor), high = std::max<double>(values.max, anchor);
  // One value: it is the first node; the other one only has to be apart from it in single precision.
  if (!(high - low > kLeastExtent)) return {anchor, std::max(1.0, 1e-3 * std::abs(anchor)), 0, 2};
  // The anchor is node k; the step is the smallest that still reaches both ends.
  const int k = std::clamp(static_cast<int>(std::lround((anchor - low) / (high - low) * (nodes - 1))),
                           anchor > low ? 1 : 0, anchor < high ? nodes - 2 : nodes - 1);
  const double below = k > 0 ? (anchor - low) / k : 0, above = k < nodes - 1 ? (high - anchor) / (nodes - 1 - k) : 0;
  return {anchor, std::max(below, above), k, nodes};
}

Range TransferLookup::Axis::around(const Range& values) const {
  const auto place = [&](double steps) {
    return static_cast<float>(node(static_cast<int>(std::clamp<double>(steps + anchorNode, 0, nodes - 1))));
  };
  Range nodeRange{place(std::floor((values.min - anchor) / step)), place(std::ceil((values.max - anchor) / step))};
  // Rounding to float must not narrow it.
  nodeRange.include(Range{std::min(nodeRange.min, values.min), std::max(nodeRange.max, values.max)});
  return nodeRange;
}

TransferLookup::TransferLookup(const GlFunctions& gl, const TransferFunction& transfer, const SamplingOptions& sampling,
                               const Bricks& volume)
    : transfer_(bounded(transfer, sampling.spacing)),
      mode_(transfer.is2d()                                    ? 2
            : sampling.quadrature == Quadrature::preintegrated ? 0
                                                               : 1) {
  // An inner anchor needs a node on either side.
  const auto nodes = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(sampling.tableSize, 3))));
  value_ = makeAxis(volume.value, volume.background, nodes);
  if (mode_ == 2) gradient_ = makeAxis(volume.gradient, 0, nodes);
  std::vector<glm::vec4> entries;
  int rows = 1;
  if (mode_ == 0) {
    const Range covered{static_cast<float>(-value_.anchorNode),
                        static_cast<float>(value_.nodes - 1 - value_.anchorNode)};
    entries = preintegrate(inSteps(transfer_, value_.anchor, value_.step), covered, value_.nodes,
                           sampling.spacing / sampling.segments);
    rows = value_.nodes;
  } else {
    rows = gradient_.nodes;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < value_.nodes; ++i) {
        const Medium medium = transfer_(value_.node(i), gradient_.node(j));
        entries.emplace_back(glm::vec3(medium.sigma_s()), static_cast<float>(medium.sigma_t));
      }
  }
  texture_ = makeTexture2d(gl, GL_RGBA32F, value_.nodes, rows, GL_LINEAR);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage2D(texture_.name(), 0, 0, 0, value_.nodes, rows, GL_RGBA, GL_FLOAT, entries.data());
}

bool TransferLookup::isVisible(const Range& value, const Range& gradient) const {
  if (value.empty()) return false;
  Range values = value_.around(value);
  // At a step the table holds the mean of both sides, but a range that begins there has only the upper one.
  const auto [step, behind] = std::equal_range(transfer_.values().begin(), transfer_.values().end(), values.min);
  if (behind - step > 1) values.min = std::nextafter(values.min, -std::numeric_limits<float>::infinity());
  return !transfer_.isTransparent(values, mode_ == 2 ? gradient_.around(gradient) : Range{0, 0});
}

void TransferLookup::setUniforms(GlProgram& program, const BrickAtlas& atlas) const {
  // Texture coordinates of node i are (i + 1/2) / nodes.
  const double perTexel = atlas.valueScale().scale / (value_.step * value_.nodes);
  const double perGradient = 1 / (gradient_.step * gradient_.nodes);
  program.set("transfer_map", glm::vec4(perTexel, perGradient, (value_.anchorNode + 0.5) / value_.nodes,
                                        (gradient_.anchorNode + 0.5) / gradient_.nodes));
  // Fixed point becomes float by a division or a product, and filters add weights up: some units in the last place.
  const double empty = atlas.texelOf(static_cast<float>(value_.anchor));
  program.set("empty_texel", glm::vec2(empty, std::abs(empty) * 0x1p-21));
}

}  // namespace umbrick
