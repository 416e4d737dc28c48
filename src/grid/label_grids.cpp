// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/label_grids.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>

#include "grid/label_names.h"
#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr float kMostLabel = 16777216;  // integers beyond are not told apart as floats

using LeafMask = Leaf::NodeMaskType;

// Which voxels of a leaf have a label.
struct LabelMask {
  LabelKey key;
  LeafMask mask;
};

// The slices of a layer of leaves, with the labels of each leaf.
class LabelSlab {
 public:
  explicit LabelSlab(VoxelSource& source) : source_(source), atOnce_(slabSlices(source.info().dims)) {
    checkSlabFits(source.info(), source.info().valuesPerVoxel * std::min(atOnce_, source.info().dims.z));
  }

  /// @return false behind the last slice
  bool next() {
    const VolumeInfo& info = source_.info();
    first_ += slices_;
    slices_ = std::clamp<std::int64_t>(info.dims.z - first_, 0, atOnce_);
    if (slices_ == 0) return false;
    values_.resize(static_cast<std::size_t>(info.dims.x * info.dims.y * slices_ * info.valuesPerVoxel));
    if (source_.readSlab(slices_, values_) > 0)
      throw InvalidArgument(info.name + ": expected labels that are integers up to 16777216, found others");
    return true;
  }
  double share() const { return double(first_ + slices_) / double(source_.info().dims.z); }

  glm::i64vec3 leafCounts() const {
    return (glm::i64vec3(source_.info().dims.x, source_.info().dims.y, slices_) + (kLeafEdge - 1)) / kLeafEdge;
  }
  std::int64_t leaves() const {
    const glm::i64vec3 count = leafCounts();
    return count.x * count.y * count.z;
  }
  openvdb::Coord origin(std::int64_t i) const {
    const glm::i64vec3 from = fromOf(i);
    return {int(from.x), int(from.y), int(from.z)};
  }

  /// The labels of the voxels of a leaf. @throw InvalidArgument  a voxel is no integer, or too large
  void labelsOf(std::int64_t i, std::vector<LabelMask>& out) const {
    const glm::i64vec3& dims = source_.info().dims;
    const std::int64_t several = source_.info().valuesPerVoxel;
    const glm::i64vec3 from = fromOf(i),
                       to = glm::min(from + kLeafEdge, glm::i64vec3(dims.x, dims.y, first_ + slices_));
    out.clear();
    std::size_t last = 0;
    for (std::int64_t z = from.z; z < to.z; ++z)
      for (std::int64_t y = from.y; y < to.y; ++y)
        for (std::int64_t x = from.x; x < to.x; ++x) {
          const float* voxel = values_.data() + (((z - first_) * dims.y + y) * dims.x + x) * several;
          for (std::int64_t component = 0; component < several; ++component) {
            if (voxel[component] == 0) continue;
            const LabelKey key{component, labelOf(voxel[component])};
            if (last >= out.size() || out[last].key != key) {
              last = 0;
              while (last < out.size() && out[last].key != key) ++last;
              if (last == out.size()) out.push_back({key, {}});
            }
            out[last].mask.setOn(static_cast<openvdb::Index>(((x & 7) << 6) | ((y & 7) << 3) | (z & 7)));
          }
        }
  }

 private:
  glm::i64vec3 fromOf(std::int64_t i) const {
    const glm::i64vec3 count = leafCounts();
    return glm::i64vec3(i % count.x, i / count.x % count.y, i / (count.x * count.y)) * kLeafEdge +
           glm::i64vec3(0, 0, first_);
  }

  std::int64_t labelOf(float value) const {
    if (value == std::floor(value) && std::abs(value) <= kMostLabel) return static_cast<std::int64_t>(value);
    std::ostringstream text;
    text << source_.info().name << ": expected labels that are integers up to 16777216, found " << value;
    throw InvalidArgument(text.str());
  }

  VoxelSource& source_;
  std::int64_t atOnce_, first_ = 0, slices_ = 0;
  std::vector<float> values_;
};

void addToTree(openvdb::FloatTree& tree, const openvdb::Coord& origin, const LeafMask& mask) {
  if (mask.isOn()) return tree.addTile(1, origin, 1.0f, true);
  auto leaf = std::make_unique<Leaf>(origin, 0.0f);
  for (auto voxel = mask.beginOn(); voxel; ++voxel) leaf->setValueOnly(voxel.pos(), 1.0f);
  leaf->setValueMask(mask);
  tree.addLeaf(leaf.release());
}

}  // namespace

LabelGrids buildLabelGrids(VoxelSource& source, const LabelChoice& choice,
                           const std::function<void(double)>& progress) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const WantedLabels wanted(info, choice);
  std::map<LabelKey, LabelGrid> found;
  LabelSlab slab(source);
  std::vector<std::vector<LabelMask>> masks;
  while (slab.next()) {
    masks.resize(static_cast<std::size_t>(slab.leaves()));
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, slab.leaves(), 64), [&](const auto& range) {
      for (std::int64_t i = range.begin(); i != range.end(); ++i) slab.labelsOf(i, masks[static_cast<std::size_t>(i)]);
    });
    for (std::size_t i = 0; i < masks.size(); ++i)
      for (const LabelMask& mask : masks[i]) {
        if (!wanted.contains(mask.key)) continue;
        LabelGrid& label = labelGrid(info, mask.key, found);
        addToTree(label.grid->tree(), slab.origin(static_cast<std::int64_t>(i)), mask.mask);
      }
    if (progress) progress(slab.share());
  }
  return wanted.collect(info, std::move(found));
}

std::vector<VerifyReport> verifyLabelGrids(VoxelSource& source, const std::vector<VolumeLabel>& labels,
                                           const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                                           const std::function<void(double)>& progress) {
  const VolumeInfo& info = source.info();
  const std::map<LabelKey, std::size_t> places = placesOf(labels);
  std::vector<VerifyReport> reports(grids.size());
  std::vector<std::uint64_t> right(grids.size(), 0);
  LabelSlab slab(source);
  std::vector<LabelMask> masks;
  while (slab.next()) {
    for (std::int64_t i = 0; i < slab.leaves(); ++i) {
      slab.labelsOf(i, masks);
      const openvdb::Coord origin = slab.origin(i);
      for (const LabelMask& mask : masks) {
        const auto place = places.find(mask.key);
        if (place == places.end()) continue;
        for (auto voxel = mask.mask.beginOn(); voxel; ++voxel) {
          float value = 0;
          const openvdb::Coord at = origin + Leaf::offsetToLocalCoord(voxel.pos());
          const bool active = grids[place->second]->tree().probeValue(at, value);
          right[place->second] += active;
          reports[place->second].error.max =
              std::max(reports[place->second].error.max, std::abs(1.0 - static_cast<double>(value)));
        }
      }
    }
    if (progress) progress(slab.share());
  }
  for (std::size_t i = 0; i < grids.size(); ++i) {
    reports[i].voxels = voxelsIn(info);
    reports[i].beyond = grids[i]->activeVoxelCount() - right[i];
  }
  return reports;
}

}  // namespace umbrick
