// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/value_survey.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using Leaves = openvdb::tree::LeafManager<const openvdb::FloatTree>;
constexpr int kLeafEdge = static_cast<int>(Leaf::DIM);
constexpr openvdb::Index kStrides[3]{kLeafEdge * kLeafEdge, kLeafEdge, 1};

// Calls action(value, box) for each active tile.
template <class Action>
void visitTiles(const openvdb::FloatTree& tree, const Action& action) {
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) action(*tile, tile.getBoundingBox());
}

double voxelsOf(const openvdb::CoordBBox& box) { return static_cast<double>(box.volume()); }

// Sums over all leaves with a state of its own for each part of them.
template <class State, class Look>
State overLeaves(const Leaves& leaves, const State& start, const Look& look) {
  return tbb::parallel_reduce(
      leaves.leafRange(), start,
      [&](const auto& range, State state) {
        for (auto leaf = range.begin(); leaf; ++leaf) look(*leaf, state);
        return state;
      },
      [](State a, const State& b) {
        a.add(b);
        return a;
      });
}

// --- first look: extremes, a sample of values, whole numbers ---

struct Extremes {
  Range value;
  std::uint64_t voxels = 0;
  std::vector<float> sample;
  bool whole = true;
  std::map<float, std::uint64_t> distinct;  // no more than one beyond kMostDistinct

  void count(float value_, std::uint64_t times) {
    value.include(value_);
    voxels += times;
    whole = whole && value_ == std::floor(value_);
    if (whole && (distinct.size() <= kMostDistinct || distinct.contains(value_))) distinct[value_] += times;
  }
  void add(const Extremes& other) {
    if (!other.value.empty()) value.include(other.value);
    voxels += other.voxels;
    sample.insert(sample.end(), other.sample.begin(), other.sample.end());
    whole = whole && other.whole;
    for (const auto& [v, n] : other.distinct)
      if (distinct.size() <= kMostDistinct || distinct.contains(v)) distinct[v] += n;
  }
};

Extremes findExtremes(const openvdb::FloatTree& tree, const Leaves& leaves) {
  // About a million values are enough to know that one in two thousand lies beyond.
  const std::size_t every = std::max<std::size_t>(1, leaves.leafCount() * Leaf::SIZE >> 20);
  Extremes found = overLeaves(leaves, Extremes{}, [&](const Leaf& leaf, Extremes& state) {
    std::size_t next = 0;
    float last = 0;
    std::uint64_t run = 0;  // of equal values, which are counted together
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const float value = *voxel;
      if (!std::isfinite(value)) continue;
      if (run > 0 && value != last) {
        state.count(last, run);
        run = 0;
      }
      last = value;
      ++run;
      if (voxel.pos() >= next) {
        state.sample.push_back(value);
        next = voxel.pos() + every;
      }
    }
    if (run > 0) state.count(last, run);
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& box) {
    if (!std::isfinite(value)) return;
    found.count(value, box.volume());
    const auto copies = std::min<std::uint64_t>(box.volume() / every + 1, 1 << 20);
    found.sample.insert(found.sample.end(), copies, value);
  });
  return found;
}

void findEnds(Extremes& found, ValueSurvey& survey) {
  std::vector<float>& sample = found.sample;
  const std::size_t tail = sample.size() / 2000;
  const auto at = [&](std::size_t place) {
    std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(place), sample.end());
    return double(sample[place]);
  };
  survey.low = at(tail);
  survey.high = at(sample.size() - 1 - tail);
  if (survey.low < survey.high) return;
  survey.low = found.value.min;
  survey.high = found.value.max;
  if (survey.low < survey.high) return;
  const double half = std::max(0.5 * std::abs(survey.low), 0.5);  // one value alone stands in the middle
  survey.low -= half;
  survey.high += half;
}

// --- second look: histogram and gradients ---

struct Bins {
  std::vector<double> count = std::vector<double>(kSurveyBins), gradient = count, looked = count;
  void add(const Bins& other) {
    for (std::size_t i = 0; i < count.size(); ++i) {
      count[i] += other.count[i];
      gradient[i] += other.gradient[i];
      looked[i] += other.looked[i];
    }
  }
};

bool isInside(const openvdb::Coord& local) {
  for (int axis = 0; axis < 3; ++axis)
    if (local[axis] == 0 || local[axis] == kLeafEdge - 1) return false;
  return true;
}

double gradientAt(const Leaf& leaf, openvdb::Index voxel) {
  double squares = 0;
  for (const openvdb::Index stride : kStrides) {
    const double slope = 0.5 * (double(leaf.getValue(voxel + stride)) - double(leaf.getValue(voxel - stride)));
    squares += slope * slope;
  }
  return std::sqrt(squares);
}

void countBins(const openvdb::FloatTree& tree, const Leaves& leaves, ValueSurvey& survey) {
  const double scale = kSurveyBins / (survey.high - survey.low);
  const auto binOf = [&](float value) {
    return static_cast<std::size_t>(std::clamp((double(value) - survey.low) * scale, 0.0, kSurveyBins - 1.0));
  };
  Bins bins = overLeaves(leaves, Bins{}, [&](const Leaf& leaf, Bins& state) {
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const float value = *voxel;
      if (!std::isfinite(value)) continue;
      const std::size_t bin = binOf(value);
      state.count[bin] += 1;
      if (!isInside(Leaf::offsetToLocalCoord(voxel.pos()))) continue;
      const double gradient = gradientAt(leaf, voxel.pos());
      if (!std::isfinite(gradient)) continue;
      state.gradient[bin] += gradient;
      state.looked[bin] += 1;
    }
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& box) {
    if (!std::isfinite(value)) return;
    bins.count[binOf(value)] += voxelsOf(box);
    bins.looked[binOf(value)] += voxelsOf(box);  // a tile has no gradient
  });
  survey.histogram = bins.count;
  survey.gradient = bins.gradient;
  for (std::size_t i = 0; i < bins.looked.size(); ++i)
    if (bins.looked[i] > 0) survey.gradient[i] /= bins.looked[i];
}

// --- third look: in which order whole numbers lie beside each other ---

struct Pairs {
  double different = 0, apart = 0;
  void add(const Pairs& other) {
    different += other.different;
    apart += other.apart;
  }
};

double shareOfJumps(const Leaves& leaves, const ValueSurvey& survey) {
  std::vector<double> values;
  for (const auto& [value, count] : survey.distinct) values.push_back(value);
  // The background lies beside all others and is one of the values, too.
  if (const auto place = std::lower_bound(values.begin(), values.end(), survey.background);
      place == values.end() || *place != survey.background)
    values.insert(place, survey.background);
  const auto rank = [&](float value) {
    return std::lower_bound(values.begin(), values.end(), double(value)) - values.begin();
  };
  const Pairs pairs = overLeaves(leaves, Pairs{}, [&](const Leaf& leaf, Pairs& state) {
    for (openvdb::Index voxel = 0; voxel < Leaf::SIZE; ++voxel) {
      const openvdb::Coord local = Leaf::offsetToLocalCoord(voxel);
      for (int axis = 0; axis < 3; ++axis) {
        if (local[axis] == kLeafEdge - 1) continue;
        const float here = leaf.getValue(voxel), there = leaf.getValue(voxel + kStrides[axis]);
        if (here == there || !std::isfinite(here) || !std::isfinite(there)) continue;
        state.different += 1;
        if (std::abs(rank(here) - rank(there)) > 1) state.apart += 1;
      }
    }
  });
  return pairs.different > 0 ? pairs.apart / pairs.different : 0;
}

// --- columns ---

// A picture of columns, which several voxels share where the grid is large.
struct Columns {
  int across = 0, down = 0;  // the two axes of the picture
  IndexBox box;
  int perColumn = 1;  // voxels along each of the two
  int width = 0, height = 0;
  std::vector<double> sums = {};

  Columns(const IndexBox& active, int axis) : across((axis + 1) % 3), down((axis + 2) % 3), box(active) {
    constexpr std::int64_t kMost = 512;
    const glm::i64vec3 extent = box.extent();
    perColumn = static_cast<int>((std::max(extent[across], extent[down]) + kMost - 1) / kMost);
    width = static_cast<int>((extent[across] + perColumn - 1) / perColumn);
    height = static_cast<int>((extent[down] + perColumn - 1) / perColumn);
    sums.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  int column(int index) const { return (index - box.min[across]) / perColumn; }
  int row(int index) const { return (index - box.min[down]) / perColumn; }
  double& at(int x, int y) { return sums[static_cast<std::size_t>(y) * std::size_t(width) + std::size_t(x)]; }
  void add(const Columns& other) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += other.sums[i];
  }
};

// Adds a tile: to each column as many voxels as they share.
void addTile(Columns& columns, int axis, double weight, const openvdb::CoordBBox& box) {
  const double depth = double(box.max()[axis]) - double(box.min()[axis]) + 1;
  const auto shared = [&](int least, int most, int first) {
    return double(std::min(most, first + columns.perColumn - 1) - std::max(least, first) + 1);
  };
  for (int y = columns.row(box.min()[columns.down]); y <= columns.row(box.max()[columns.down]); ++y)
    for (int x = columns.column(box.min()[columns.across]); x <= columns.column(box.max()[columns.across]); ++x) {
      const double wide = shared(box.min()[columns.across], box.max()[columns.across],
                                 columns.box.min[columns.across] + x * columns.perColumn);
      const double high = shared(box.min()[columns.down], box.max()[columns.down],
                                 columns.box.min[columns.down] + y * columns.perColumn);
      columns.at(x, y) += weight * depth * wide * high;
    }
}

struct Bounds {
  openvdb::CoordBBox box;
  void add(const Bounds& other) {
    if (!other.box.empty()) box.expand(other.box);
  }
};

}  // namespace

ValueSurvey surveyValues(const ScalarGrid& grid) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const Leaves leaves(tree);
  ValueSurvey survey;
  survey.background = tree.background();
  const glm::i64vec3 extent = grid.activeBox().extent();
  survey.boxVoxels = std::uint64_t(extent.x) * std::uint64_t(extent.y) * std::uint64_t(extent.z);
  Extremes found = findExtremes(tree, leaves);
  survey.voxels = found.voxels;
  survey.value = found.value;
  survey.wholeNumbers = found.whole && found.voxels > 0;
  if (found.voxels == 0) return survey;
  findEnds(found, survey);
  countBins(tree, leaves, survey);
  if (survey.wholeNumbers && found.distinct.size() <= kMostDistinct) {
    for (const auto& [value, count] : found.distinct) survey.distinct.emplace_back(value, count);
    survey.jumps = shareOfJumps(leaves, survey);
  }
  return survey;
}

std::vector<double> columnIntegrals(const ScalarGrid& grid, int axis, const std::function<double(double)>& weight) {
  const IndexBox box = grid.activeBox();
  if (box.empty()) return {};
  const openvdb::FloatTree& tree = grid.grid->tree();
  const Leaves leaves(tree);
  Columns columns = overLeaves(leaves, Columns(box, axis), [&](const Leaf& leaf, Columns& state) {
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const float value = *voxel;
      if (!std::isfinite(value)) continue;
      const openvdb::Coord at = voxel.getCoord();
      state.at(state.column(at[state.across]), state.row(at[state.down])) += weight(value);
    }
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& tile) {
    if (std::isfinite(value)) addTile(columns, axis, weight(value), tile);
  });
  const double length = glm::length(glm::dvec3(grid.indexToWorld()[axis]));
  const double shared = double(columns.perColumn) * columns.perColumn;
  std::vector<double> integrals;
  for (const double sum : columns.sums)
    if (sum > 0) integrals.push_back(sum * length / shared);
  return integrals;
}

IndexBox acceptedBox(const ScalarGrid& grid, const std::function<bool(double)>& accepts) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const Leaves leaves(tree);
  Bounds bounds = overLeaves(leaves, Bounds{}, [&](const Leaf& leaf, Bounds& state) {
    // A leaf whose voxels lie inside already changes nothing.
    if (!state.box.empty() && state.box.isInside(leaf.getNodeBoundingBox())) return;
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
      if (accepts(*voxel)) state.box.expand(voxel.getCoord());
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& tile) {
    if (accepts(value)) bounds.box.expand(tile);
  });
  if (bounds.box.empty()) return {};
  const auto &low = bounds.box.min(), &high = bounds.box.max();
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

}  // namespace umbrick
