// SPDX-License-Identifier: Apache-2.0
#include "reference/field.h"

#include <openvdb/tools/Dense.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>

#include "reference/voxel_gradient.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {
using openvdb::Coord;
using openvdb::CoordBBox;
using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kVoxels = FieldBlock::kVoxels, kCells = FieldBlock::kCells;
constexpr std::size_t kBlockSize = static_cast<std::size_t>(kVoxels) * kVoxels * kVoxels;

// What one thread has seen of the tree.
struct Seen {
  CoordBBox extent;
  std::uint64_t nonFinite = 0;
};

// Calls visit(value, active, box) for the tiles above the level of leaves.
template <class Visit>
void forEachTile(const openvdb::FloatTree& tree, const Visit& visit) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(tile.getLeafDepth() - 1);
  for (; tile; ++tile) visit(*tile, tile.isValueOn(), tile.getBoundingBox());
}

// Returns the blocks that read one of the voxels in `box`. A block also reads `reach` voxels beyond its
// own on each side.
CoordBBox blocksOf(const CoordBBox& box, int reach) {
  const Coord &a = box.min(), &b = box.max();
  const auto low = [&](int x) { return static_cast<int>((std::int64_t(x) - kCells - reach + kCells - 1) >> 3); };
  const auto high = [&](int x) { return static_cast<int>((std::int64_t(x) + reach) >> 3); };
  return {Coord(low(a.x()), low(a.y()), low(a.z())), Coord(high(b.x()), high(b.y()), high(b.z()))};
}

// Reads the voxels of one block with `margin` on each side, x fastest. Those that are not finite become background.
class BlockReader {
 public:
  BlockReader(const openvdb::FloatTree& tree, const glm::dmat4& indexToWorld, float background, bool gradients,
              GradientFilter filter, const openvdb::FloatTree* emission)
      : tree_(tree),
        emission_(emission),
        covariant_(glm::transpose(glm::inverse(glm::dmat3(indexToWorld)))),
        background_(background),
        gradients_(gradients),
        filter_(filter) {}

  // @param values  receives kBlockSize floats, and behind them as many gradients if there are any, and values of the
  //   second grid
  void read(const Coord& block, float* values) {
    const int margin = gradients_ ? 1 : 0, edge = kVoxels + 2 * margin;
    const Coord first = Coord(block.x() * kCells, block.y() * kCells, block.z() * kCells).offsetBy(-margin);
    scratch_.resize(static_cast<std::size_t>(edge) * edge * edge);
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(CoordBBox::createCube(first, edge), scratch_.data());
    openvdb::tools::copyToDense(tree_, dense, true);
    for (float& value : scratch_)
      if (!std::isfinite(value)) value = background_;
    for (int z = 0; z < kVoxels; ++z)
      for (int y = 0; y < kVoxels; ++y)
        for (int x = 0; x < kVoxels; ++x) {
          const std::ptrdiff_t at = ((z + margin) * edge + y + margin) * edge + x + margin;
          const auto to = static_cast<std::size_t>((z * kVoxels + y) * kVoxels + x);
          values[to] = scratch_[static_cast<std::size_t>(at)];
          if (gradients_) values[kBlockSize + to] = magnitude(scratch_.data() + at, edge);
        }
    if (emission_) readEmission(first.offsetBy(margin), values + (gradients_ ? 2 : 1) * kBlockSize);
  }

 private:
  // Turns the gradient per voxel into one per world unit.
  float magnitude(const float* v, std::ptrdiff_t edge) const {
    const glm::dvec3 gradient = voxelGradient(
        glm::dvec3(0), filter_, [&](int i, int j, int k) { return double(v[(k * edge + j) * edge + i]); });
    const double size = glm::length(covariant_ * gradient);
    return static_cast<float>(std::min<double>(size, std::numeric_limits<float>::max()));
  }

  void readEmission(const Coord& first, float* values) const {
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(CoordBBox::createCube(first, kVoxels), values);
    openvdb::tools::copyToDense(*emission_, dense, true);
    const float dark = std::isfinite(emission_->background()) ? emission_->background() : 0.0f;
    for (float* value = values; value != values + kBlockSize; ++value)
      if (!std::isfinite(*value)) *value = dark;
  }

  const openvdb::FloatTree& tree_;
  const openvdb::FloatTree* emission_;
  glm::dmat3 covariant_;
  float background_;
  bool gradients_;
  GradientFilter filter_;
  std::vector<float> scratch_;
};

Range rangeOf(const float* values, std::size_t count) {
  const auto [low, high] = std::minmax_element(values, values + count);
  return {*low, *high};
}

std::uint8_t kindOf(const Classifier& classifier, const Range& values) {
  const std::optional<std::size_t> stretch = classifier.onlyStretch(values);
  return stretch && *stretch + 1 < FieldBlock::kMixed ? static_cast<std::uint8_t>(*stretch + 1) : FieldBlock::kMixed;
}

// Tells what each cell is and bounds sigma_t. Without skipping, cells are not looked at here but when a ray
// comes to them.
// @return false when there is nothing to see in the block
bool survey(FieldBlock& block, const Classifier& classifier, bool skipEmpty, const Classifier* emission) {
  const auto emits = [&](const Range& values) { return !emission->transfer().isTransparent(values); };
  if (block.emissions && !emits(rangeOf(block.emissions, kBlockSize))) block.emissions = nullptr;
  const TransferFunction& transfer = classifier.transfer();
  const auto gradientsOf = [&](const auto& rangeOfPart) {
    return block.gradients ? rangeOfPart(block.gradients) : Range{0, 0};
  };
  const Range all = rangeOf(block.values, kBlockSize);
  const Range allGradients = gradientsOf([](const float* g) { return rangeOf(g, kBlockSize); });
  block.sigma_maj = transfer.majorant(all, allGradients);
  if (!skipEmpty) {
    block.kinds.fill(FieldBlock::kMixed);
    return true;
  }
  if (!block.emissions && transfer.isTransparent(all, allGradients)) return false;
  bool seen = false;
  auto kind = block.kinds.begin();
  for (int z = 0; z < kCells; ++z)
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x, ++kind) {
        const auto cell = [&](const float* v) { return rangeOfCell(v, {x, y, z}); };
        const Range values = cell(block.values);
        const bool transparent = transfer.isTransparent(values, gradientsOf(cell));
        const bool dark = !block.emissions || !emits(cell(block.emissions));
        *kind = transparent && dark ? FieldBlock::kTransparent : kindOf(classifier, values);
        seen = seen || !transparent || !dark;
      }
  return seen;
}

}  // namespace

Field::Field(const ScalarGrid& grid, const Classifier& classifier, GradientFilter filter, bool skipEmpty,
             const Classifier* emission)
    : skipEmpty_(skipEmpty) {
  const TransferFunction& transfer = classifier.transfer();
  const openvdb::FloatTree& tree = grid.grid->tree();
  background_ = std::isfinite(tree.background()) ? tree.background() : 0.0f;
  findDomain(tree, emission ? &grid.emission->tree() : nullptr);
  const int background = skipEmpty && transfer.isTransparent({background_, background_}, {0, 0})
                             ? -1
                             : uniformBlock(background_, transfer);
  tree_ = std::make_unique<BlockTree>(background);
  if (!domain_.empty()) addBlocks(grid, classifier, filter, emission);
}

Field::~Field() = default;

namespace {

// Looks at all that is active or differs from the background.
Seen seenOf(const openvdb::FloatTree& tree, float background) {
  std::vector<const Leaf*> leaves;
  tree.getNodes(leaves);
  tbb::enumerable_thread_specific<Seen> seen;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 64), [&](const auto& range) {
    Seen& mine = seen.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      for (auto voxel = leaves[i]->cbeginValueAll(); voxel; ++voxel) {
        const bool finite = std::isfinite(*voxel);
        if (voxel.isValueOn() && !finite) ++mine.nonFinite;
        if (voxel.isValueOn() || (finite && *voxel != background)) mine.extent.expand(voxel.getCoord());
      }
  });
  Seen all;
  forEachTile(tree, [&](float value, bool active, const CoordBBox& box) {
    const bool finite = std::isfinite(value);
    if (active && !finite) all.nonFinite += box.volume();
    if (active || (finite && value != background)) all.extent.expand(box);
  });
  for (const Seen& mine : seen) {
    if (!mine.extent.empty()) all.extent.expand(mine.extent);
    all.nonFinite += mine.nonFinite;
  }
  return all;
}

}  // namespace

void Field::findDomain(const openvdb::FloatTree& tree, const openvdb::FloatTree* emission) {
  Seen all = seenOf(tree, background_);
  if (emission) {
    const Seen second = seenOf(*emission, std::isfinite(emission->background()) ? emission->background() : 0.0f);
    if (!second.extent.empty()) all.extent.expand(second.extent);
    all.nonFinite += second.nonFinite;
  }
  nonFinite_ = all.nonFinite;
  if (all.extent.empty()) return;
  // Blocks beyond the domain must have coordinates, too, and OpenVDB 10's copyToDense overflows in the last root node.
  constexpr int least = -std::numeric_limits<int>::max() + 2 * kCells;
  constexpr int most = std::numeric_limits<int>::max() - 4096 - 2 * kCells;
  for (int axis = 0; axis < 3; ++axis) {
    const int low = all.extent.min()[axis], high = all.extent.max()[axis];
    if (low < least || high > most)
      throw InvalidArgument("the grid reaches voxel " + std::to_string(low < least ? low : high) +
                            " along an axis, the reference takes " + std::to_string(least) + " to " +
                            std::to_string(most));
  }
  const Coord a = all.extent.min().offsetBy(-1), b = all.extent.max().offsetBy(1);
  domain_ = {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
}

int Field::uniformBlock(float value, const TransferFunction& transfer) {
  FieldBlock block;
  block.uniform = value;
  block.sigma_maj = transfer(value, 0).sigma_t;
  block.kinds.fill(FieldBlock::kMixed);
  if (!skipEmpty_) {
    storage_.push_back(std::make_unique<float[]>(2 * kBlockSize));
    std::fill_n(storage_.back().get(), kBlockSize, value);
    block.values = storage_.back().get();
    if (transfer.is2d()) block.gradients = block.values + kBlockSize;
  }
  blocks_.push_back(block);
  return static_cast<int>(blocks_.size()) - 1;
}

namespace {

// Adds the blocks that may emit something. What lies in a tile of the second grid is taken block by block.
void addEmitting(const openvdb::FloatTree& tree, const TransferFunction& emitted, std::set<Coord>& wanted) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 22;
  std::uint64_t count = 0;
  const auto add = [&](const CoordBBox& box) {
    const CoordBBox touched = blocksOf(box, 0);
    count += touched.volume();
    if (count > kMost)
      throw InvalidArgument("volume.emissionGrid: what emits fills " + std::to_string(count) +
                            " blocks of 8 x 8 x 8 voxels or more, the reference takes " + std::to_string(kMost));
    for (auto block = touched.begin(); block != touched.end(); ++block) wanted.insert(*block);
  };
  std::vector<const Leaf*> leaves;
  tree.getNodes(leaves);
  for (const Leaf* leaf : leaves) add(leaf->getNodeBoundingBox());
  forEachTile(tree, [&](float value, bool, const CoordBBox& box) {
    if (std::isfinite(value) && !emitted.isTransparent({value, value})) add(box);
  });
}

}  // namespace

void Field::addBlocks(const ScalarGrid& grid, const Classifier& classifier, GradientFilter filter,
                      const Classifier* emission) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const openvdb::FloatTree* const second = emission ? &grid.emission->tree() : nullptr;
  const glm::dmat4 indexToWorld = grid.indexToWorld();
  const TransferFunction& transfer = classifier.transfer();
  const bool gradients = transfer.is2d();
  const int reach = gradients ? 1 : 0;
  // Tiles come first. All blocks inside a tile are alike; those at its faces are looked at one by one below.
  std::set<Coord> borders;
  std::map<float, int> uniform;
  forEachTile(tree, [&](float value, bool, const CoordBBox& box) {
    if (!std::isfinite(value) || value == background_) return;
    const CoordBBox touched = blocksOf(box, reach);
    const auto low = [&](int x) { return (x + reach + kCells - 1) >> 3; };
    const auto high = [&](int x) { return (x - reach - kCells) >> 3; };
    const CoordBBox inner(Coord(low(box.min().x()), low(box.min().y()), low(box.min().z())),
                          Coord(high(box.max().x()), high(box.max().y()), high(box.max().z())));
    if (!inner.empty()) {
      const bool transparent = skipEmpty_ && transfer.isTransparent({value, value}, {0, 0});
      if (!uniform.count(value)) uniform[value] = transparent ? -1 : uniformBlock(value, transfer);
      tree_->fill(inner, uniform[value], true);
    }
    for (auto block = touched.begin(); block != touched.end(); ++block)
      if (inner.empty() || !inner.isInside(*block)) borders.insert(*block);
  });
  std::set<Coord> wanted = borders;
  std::vector<const Leaf*> leaves;
  tree.getNodes(leaves);
  for (const Leaf* leaf : leaves) {
    const CoordBBox touched = blocksOf(leaf->getNodeBoundingBox(), reach);
    for (auto block = touched.begin(); block != touched.end(); ++block) wanted.insert(*block);
  }
  if (second) addEmitting(*second, emission->transfer(), wanted);
  // Many blocks at the faces of tiles have the same voxels, which are kept only once. The blocks are taken in parts, so
  // that few are held at a time.
  std::unordered_map<std::string_view, int> looks;
  const std::size_t emissionAt = kBlockSize * (gradients ? 2 : 1), size = emissionAt + (second ? kBlockSize : 0);
  const std::vector<Coord> all(wanted.begin(), wanted.end());
  constexpr std::size_t part = 16384;
  for (std::size_t first = 0; first < all.size(); first += part) {
    const std::span<const Coord> coords = std::span(all).subspan(first, std::min(part, all.size() - first));
    std::vector<FieldBlock> found(coords.size());
    std::vector<std::unique_ptr<float[]>> voxels(coords.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, coords.size(), 16), [&](const auto& range) {
      BlockReader reader(tree, indexToWorld, background_, gradients, filter, second);
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        if (!voxels[i]) voxels[i] = std::make_unique<float[]>(size);
        reader.read(coords[i], voxels[i].get());
        found[i].values = voxels[i].get();
        if (gradients) found[i].gradients = voxels[i].get() + kBlockSize;
        if (second) found[i].emissions = voxels[i].get() + emissionAt;
        if (!survey(found[i], classifier, skipEmpty_, emission)) voxels[i].reset();
      }
    });
    for (std::size_t i = 0; i < coords.size(); ++i) {
      int index = -1;
      if (voxels[i]) {
        ++denseBlocks_;
        index = static_cast<int>(blocks_.size());
        if (borders.count(coords[i])) {
          const std::string_view look(reinterpret_cast<const char*>(voxels[i].get()), size * sizeof(float));
          index = looks.try_emplace(look, index).first->second;
        }
        if (index == static_cast<int>(blocks_.size())) {
          blocks_.push_back(found[i]);
          storage_.push_back(std::move(voxels[i]));
        }
      }
      // A block that is transparent anyway needs no node.
      if (index >= 0 || tree_->getValue(coords[i]) >= 0) tree_->setValueOn(coords[i], index);
    }
  }
}

}  // namespace umbrick
