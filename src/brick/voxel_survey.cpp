// SPDX-License-Identifier: Apache-2.0
#include "brick/voxel_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "brick/leaf_range.h"
#include "brick/tree_walk.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr int kLeafEdge = FloatLeaf::DIM;
constexpr int kLeafVoxels = FloatLeaf::SIZE;
static_assert(kLeafEdge == 8, "a leaf is eight words of one bit per voxel");
using LeafBits = std::array<std::uint64_t, kLeafEdge>;  // word x, bit 8 y + z

bool isWhole(float value) {
  // From 2^24 on every float is a whole number. Smaller ones fit an int.
  const float small = std::abs(value) < 16777216.0f ? value : 0.0f;
  return static_cast<float>(static_cast<int>(small)) == small;
}

// Returns whether a float with 5 bits of exponent and 10 of mantissa has this value exactly.
bool isHalf(float value) {
  const float size = std::abs(value);
  const bool tenBits = (std::bit_cast<std::uint32_t>(value) & 0x1fffu) == 0;
  // Below the smallest normal half, 2^-14, half floats are the multiples of 2^-24.
  return size < 0x1p-14f ? isWhole(size * 0x1p24f) : tenBits && size <= 65504.0f;
}

bool allFinite(const float* values) {
  std::uint32_t found = 0;
  for (int i = 0; i < kLeafVoxels; ++i) found |= (std::bit_cast<std::uint32_t>(values[i]) & 0x7f800000u) == 0x7f800000u;
  return found == 0;
}

LeafBits bitsThatDiffer(const float* values, float background) {
  LeafBits bits{};
  for (int i = 0; i < kLeafVoxels; ++i) bits[i / 64] |= std::uint64_t(values[i] != background) << (i % 64);
  return bits;
}

// Returns the box in index space of the bits that are set, of which there must be one at least.
openvdb::CoordBBox boxOfBits(const LeafBits& bits, const openvdb::Coord& origin) {
  int firstX = 8, lastX = -1;
  std::uint64_t yz = 0;
  for (int x = 0; x < kLeafEdge; ++x)
    if (bits[x]) {
      firstX = std::min(firstX, x);
      lastX = x;
      yz |= bits[x];
    }
  std::uint64_t z = yz | yz >> 32;
  z |= z >> 16;
  z = (z | z >> 8) & 0xff;
  return {origin.offsetBy(firstX, std::countr_zero(yz) / 8, std::countr_zero(z)),
          origin.offsetBy(lastX, 7 - std::countl_zero(yz) / 8, 63 - std::countl_zero(z))};
}

[[noreturn]] void throwTooMany(int interior) {
  const std::string edge = std::to_string(interior);
  throw InvalidArgument("the grid reaches more than " + std::to_string(kMaxCells) + " bricks of " + edge + " x " +
                        edge + " x " + edge + " voxels; use larger bricks or a smaller grid");
}

// Returns the median of the values where their middle half is much narrower than its distance from 0, else 0. The
// middle half is taken so that some values far off do not matter. Each value counts once, however many voxels have it,
// so that a marker of missing data is one among many.
float anchorOf(std::vector<float>& values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const auto quartile = [&](std::size_t quarters) { return values[(values.size() - 1) * quarters / 4]; };
  const float low = quartile(1), median = quartile(2), high = quartile(3);
  constexpr double kFarther = 256;  // in spreads of the middle half: eight bits that single precision gains
  return (static_cast<double>(high) - low) * kFarther < std::abs(static_cast<double>(median)) ? median : 0;
}

// A growing list of cells that keeps each cell once.
class CellList {
 public:
  void add(const glm::ivec3& cell, int interior) {
    if (!cells_.empty() && cells_.back() == cell) return;  // neighbouring leaves mostly share a cell
    cells_.push_back(cell);
    if (cells_.size() < room_) return;
    compact();
    if (cells_.size() > kMaxCells) throwTooMany(interior);
    room_ = std::max(room_, 2 * cells_.size());
  }
  void add(const CellList& other) { cells_.insert(cells_.end(), other.cells_.begin(), other.cells_.end()); }
  void compact() {
    std::sort(cells_.begin(), cells_.end(), comesBefore);
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  }
  std::vector<glm::ivec3>& cells() { return cells_; }

 private:
  std::vector<glm::ivec3> cells_;
  std::size_t room_ = 1 << 16;
};

// What one thread has seen.
class Surveyor {
 public:
  Surveyor(float background, int interior, int reach)
      : background_(background),
        interior_(interior),
        reach_(reach),
        whole_(isWhole(background)),
        half_(isHalf(background)) {
    value_.include(background);
  }

  void see(const FloatLeaf& leaf) {
    const float* values = leaf.buffer().data();
    std::array<float, kLeafVoxels> finite;
    if (!allFinite(values)) {
      for (int i = 0; i < kLeafVoxels; ++i) {
        const bool good = std::isfinite(values[i]);
        finite[i] = good ? values[i] : background_;
        nonFinite_ += !good && leaf.isValueOn(i);
      }
      hasNonFinite_ = true;
      values = finite.data();
    }
    const Range range = rangeOfLeaf(values);
    value_.include(range);
    // A few voxels of each leaf, spread over it, stand for all; the extremes stand for thin structures between them.
    for (const float value : {values[73], values[201], values[310], values[438], range.min, range.max})
      if (value != background_) samples_.push_back(value);
    for (int i = 0; whole_ && i < kLeafVoxels; ++i) whole_ = isWhole(values[i]);
    for (int i = 0; half_ && i < kLeafVoxels; ++i) half_ = isHalf(values[i]);

    LeafBits bits{};
    const bool allDiffer = !range.contains(background_);
    if (allDiffer)
      bits.fill(~std::uint64_t(0));
    else if (range.extent() > 0)
      bits = bitsThatDiffer(values, background_);
    if (isAnySet(bits)) reach(boxOfBits(bits, leaf.origin()));
    if (allDiffer) return;
    for (int x = 0; x < kLeafEdge; ++x) bits[x] |= leaf.getValueMask().getWord<std::uint64_t>(x);
    if (isAnySet(bits)) extent_.expand(boxOfBits(bits, leaf.origin()));
  }

  void see(float value, bool active, const openvdb::CoordBBox& tile) {
    if (!std::isfinite(value)) {
      hasNonFinite_ = true;
      if (active) nonFinite_ += tile.volume();
      value = background_;
    }
    if (active) extent_.expand(tile);
    if (value == background_) return;
    value_.include(value);
    samples_.push_back(value);
    whole_ = whole_ && isWhole(value);
    half_ = half_ && isHalf(value);
    reach(tile);
  }

  // Surveys the tiles of a node.
  template <class Node>
  void see(const Node& node) {
    for (auto tile = node.cbeginValueAll(); tile; ++tile) {
      if (tile.getValue() == background_ && !tile.isValueOn()) continue;
      see(tile.getValue(), tile.isValueOn(), openvdb::CoordBBox::createCube(tile.getCoord(), Node::ChildNodeType::DIM));
    }
  }

  void add(const Surveyor& other) {
    value_.include(other.value_);
    if (!other.extent_.empty()) extent_.expand(other.extent_);
    whole_ = whole_ && other.whole_;
    half_ = half_ && other.half_;
    nonFinite_ += other.nonFinite_;
    hasNonFinite_ = hasNonFinite_ || other.hasNonFinite_;
    cells_.add(other.cells_);
    samples_.insert(samples_.end(), other.samples_.begin(), other.samples_.end());
  }

  VoxelSurvey result() {
    VoxelSurvey survey;
    if (!extent_.empty()) {
      const openvdb::Coord &a = extent_.min(), &b = extent_.max();
      survey.extent = {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
    }
    survey.value = value_;
    survey.anchor = anchorOf(samples_);
    const double span = static_cast<double>(value_.max) - value_.min;
    survey.exactFormat = whole_ && span <= 255     ? VoxelFormat::unorm8
                         : whole_ && span <= 65535 ? VoxelFormat::unorm16
                         : half_                   ? VoxelFormat::half
                                                   : VoxelFormat::float32;
    survey.nonFiniteVoxels = nonFinite_;
    survey.hasNonFinite = hasNonFinite_;
    cells_.compact();
    if (cells_.cells().size() > kMaxCells) throwTooMany(interior_);
    survey.cells = std::move(cells_.cells());
    return survey;
  }

 private:
  static bool isAnySet(const LeafBits& bits) {
    return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
  }

  // Notes the cells that see voxels of `box`, all of which differ from the background or are near one that does.
  void reach(const openvdb::CoordBBox& box) {
    extent_.expand(box);
    glm::ivec3 first, last;
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = static_cast<int>(cellOf(std::int64_t(box.min()[axis]) - reach_, interior_));
      last[axis] = static_cast<int>(cellOf(std::int64_t(box.max()[axis]) + reach_, interior_));
      count *= last[axis] - first[axis] + 1;
    }
    if (count > kMaxCells) throwTooMany(interior_);
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) cells_.add({x, y, z}, interior_);
  }

  float background_;
  int interior_, reach_;
  openvdb::CoordBBox extent_;
  Range value_;
  bool whole_, half_, hasNonFinite_ = false;
  std::uint64_t nonFinite_ = 0;
  CellList cells_;
  std::vector<float> samples_;
};

}  // namespace

VoxelSurvey surveyVoxels(const openvdb::FloatTree& tree, float background, int interior, int reach) {
  const Surveyor blank(background, interior, reach);
  tbb::enumerable_thread_specific<Surveyor> surveyors(blank);
  const auto seeAll = [&]<class Node>(std::vector<const Node*> nodes) {
    tree.getNodes(nodes);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size()), [&](const auto& range) {
      Surveyor& surveyor = surveyors.local();
      for (std::size_t i = range.begin(); i != range.end(); ++i) surveyor.see(*nodes[i]);
    });
  };
  using Upper = FloatTree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  seeAll(std::vector<const FloatLeaf*>());
  seeAll(std::vector<const Lower*>());
  seeAll(std::vector<const Upper*>());
  Surveyor all = blank;
  all.see(tree.root());
  for (const Surveyor& surveyor : surveyors) all.add(surveyor);
  return all.result();
}

}  // namespace umbrick
