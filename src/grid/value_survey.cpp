// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/value_survey.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/leaf_visits.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

using Leaf = FloatLeaf;
using Leaves = FloatLeaves;
constexpr int kEdgeOfLeaf = static_cast<int>(Leaf::DIM);
constexpr openvdb::Index kLeafStrides[3]{kEdgeOfLeaf * kEdgeOfLeaf, kEdgeOfLeaf, 1};

double voxelsOf(const openvdb::CoordBBox& box) { return static_cast<double>(box.volume()); }

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
    if (local[axis] == 0 || local[axis] == kEdgeOfLeaf - 1) return false;
  return true;
}

double gradientAt(const Leaf& leaf, openvdb::Index voxel) {
  double squares = 0;
  for (const openvdb::Index stride : kLeafStrides) {
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
        if (local[axis] == kEdgeOfLeaf - 1) continue;
        const float here = leaf.getValue(voxel), there = leaf.getValue(voxel + kLeafStrides[axis]);
        if (here == there || !std::isfinite(here) || !std::isfinite(there)) continue;
        state.different += 1;
        if (std::abs(rank(here) - rank(there)) > 1) state.apart += 1;
      }
    }
  });
  return pairs.different > 0 ? pairs.apart / pairs.different : 0;
}

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

}  // namespace umbrick
