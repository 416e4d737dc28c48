// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/source_filters.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <map>
#include <sstream>
#include <unordered_map>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::int64_t kFilterSlabVoxels = std::int64_t(1) << 22;

template <class Vector>
std::string text(const Vector& v, const char* between) {
  std::ostringstream out;
  out.precision(9);
  out << v.x << between << v.y << between << v.z;
  return out.str();
}

class CroppedSource : public VoxelSource {
 public:
  CroppedSource(std::unique_ptr<VoxelSource> source, const IndexBox& box) : source_(std::move(source)), box_(box) {
    info_ = source_->info();
    const glm::i64vec3 dims = info_.dims;
    if (box.empty() || glm::any(glm::lessThan(box.min, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(glm::i64vec3(box.max), dims)))
      throw InvalidArgument(info_.name + ": crop: expected first and last voxel inside (0 0 0) to (" +
                            text(dims - std::int64_t(1), " ") + "), found (" + text(box.min, " ") + ") to (" +
                            text(box.max, " ") + ')');
    info_.dims = box.extent();
    info_.indexToWorld = glm::translate(info_.indexToWorld, glm::dvec3(box.min));
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    if (next_ == 0) source_->skipSlices(box_.min.z);
    const glm::i64vec3 whole = source_->info().dims;
    const std::int64_t several = info_.valuesPerVoxel, wholeSlice = whole.x * whole.y * several;
    double error = 0;
    auto to = out.begin();
    for (std::int64_t done = 0; done < count;) {
      const std::int64_t slices = std::clamp<std::int64_t>(kFilterSlabVoxels / wholeSlice, 1, count - done);
      slab_.resize(static_cast<std::size_t>(slices * wholeSlice));
      error = std::max(error, source_->readSlab(slices, slab_));
      for (std::int64_t z = 0; z < slices; ++z)
        for (std::int64_t y = box_.min.y; y <= box_.max.y; ++y)
          to = std::copy_n(slab_.begin() + z * wholeSlice + (y * whole.x + box_.min.x) * several,
                           info_.dims.x * several, to);
      done += slices;
    }
    next_ += count;
    // The slices behind the box are skipped too, so that a file that is too short or too long is still found out.
    if (next_ == info_.dims.z) source_->skipSlices(whole.z - 1 - box_.max.z);
    return error;
  }
  void skipSlices(std::int64_t count) override {
    if (next_ == 0) source_->skipSlices(box_.min.z);
    source_->skipSlices(count);
    next_ += count;
    if (next_ == info_.dims.z) source_->skipSlices(source_->info().dims.z - 1 - box_.max.z);
  }
  bool skipsFast() const override { return source_->skipsFast(); }

 private:
  std::unique_ptr<VoxelSource> source_;
  IndexBox box_;
  std::int64_t next_ = 0;
  std::vector<float> slab_;
};

class MaskedSource : public VoxelSource {
 public:
  MaskedSource(std::unique_ptr<VoxelSource> source, std::unique_ptr<VoxelSource> mask, float background,
               std::uint64_t* leftOut)
      : source_(std::move(source)), mask_(std::move(mask)), background_(background), leftOut_(leftOut) {
    info_ = source_->info();
    const VolumeInfo& other = mask_->info();
    if (other.dims != info_.dims)
      throw InvalidArgument(other.name + ": dims: expected " + text(info_.dims, " x ") + " as in " + info_.name +
                            ", found " + text(other.dims, " x "));
    for (int corner = 0; corner < 8; ++corner) checkCorner(corner);
    for (const std::string& note : other.notes) info_.notes.push_back("mask " + other.name + ": " + note);
    if (leftOut_) *leftOut_ = 0;
  }

  double readSlab(std::int64_t count, std::span<float> out) override {
    const double error = source_->readSlab(count, out);
    keep_.resize(out.size());
    mask_->readSlab(count, keep_);
    std::uint64_t changed = 0;
    for (std::size_t i = 0; i < out.size(); ++i)
      if (keep_[i] == 0) {
        changed += out[i] != background_;
        out[i] = background_;
      }
    if (leftOut_) *leftOut_ += changed;
    return error;
  }
  void skipSlices(std::int64_t count) override {
    source_->skipSlices(count);
    mask_->skipSlices(count);
  }
  bool skipsFast() const override { return source_->skipsFast() && mask_->skipsFast(); }

 private:
  void checkCorner(int corner) const {
    const glm::dvec3 last = glm::dvec3(info_.dims - std::int64_t(1));
    const glm::dvec4 index(corner & 1 ? last.x : 0, corner & 2 ? last.y : 0, corner & 4 ? last.z : 0, 1);
    const glm::dvec3 here(info_.indexToWorld * index), there(mask_->info().indexToWorld * index);
    double voxel = glm::length(glm::dvec3(info_.indexToWorld[0]));
    for (int axis = 1; axis < 3; ++axis) voxel = std::min(voxel, glm::length(glm::dvec3(info_.indexToWorld[axis])));
    if (!(glm::length(here - there) <= 1e-3 * voxel))
      throw InvalidArgument(mask_->info().name + ": position of voxel (" + text(index, " ") + "): expected (" +
                            text(here, " ") + ") as in " + info_.name + ", found (" + text(there, " ") + ')');
  }

  std::unique_ptr<VoxelSource> source_, mask_;
  float background_;
  std::uint64_t* leftOut_;
  std::vector<float> keep_;
};

}  // namespace

std::unique_ptr<VoxelSource> cropSource(std::unique_ptr<VoxelSource> source, const IndexBox& box) {
  return std::make_unique<CroppedSource>(std::move(source), box);
}

std::unique_ptr<VoxelSource> maskSource(std::unique_ptr<VoxelSource> source, std::unique_ptr<VoxelSource> mask,
                                        float background, std::uint64_t* leftOut) {
  return std::make_unique<MaskedSource>(std::move(source), std::move(mask), background, leftOut);
}

BorderMode borderValues(VoxelSource& source) {
  constexpr std::size_t kMostValues = std::size_t(1) << 20;
  const glm::i64vec3 dims = source.info().dims;
  const std::int64_t slice = dims.x * dims.y;
  std::unordered_map<float, std::uint64_t> counts;
  BorderMode mode;
  const auto count = [&](float value) {
    if (!std::isfinite(value)) return;
    ++mode.border;
    const auto found = counts.find(value);
    if (found != counts.end())
      ++found->second;
    else if (counts.size() < kMostValues)
      counts.emplace(value, 1);
  };
  std::vector<float> slab;
  for (std::int64_t first = 0; first < dims.z;) {
    const std::int64_t slices = std::clamp<std::int64_t>(kFilterSlabVoxels / slice, 1, dims.z - first);
    slab.resize(static_cast<std::size_t>(slices * slice));
    source.readSlab(slices, slab);
    for (std::int64_t z = 0; z < slices; ++z) {
      const bool face = first + z == 0 || first + z == dims.z - 1;
      for (std::int64_t y = 0; y < dims.y; ++y) {
        const float* row = slab.data() + z * slice + y * dims.x;
        if (face || y == 0 || y == dims.y - 1) {
          std::for_each(row, row + dims.x, count);
        } else {
          count(row[0]);
          if (dims.x > 1) count(row[dims.x - 1]);
        }
      }
    }
    first += slices;
  }
  if (counts.empty())
    throw InvalidArgument(source.info().name + ": background: expected a finite voxel on the border, found none");
  const std::map<float, std::uint64_t> ascending(counts.begin(), counts.end());
  std::uint64_t counted = 0, below = 0;
  for (const auto& [value, voxels] : ascending) {
    counted += voxels;
    if (voxels > mode.voxels) {
      mode.value = value;
      mode.voxels = voxels;
    }
  }
  mode.different = ascending.size();
  for (const auto& [value, voxels] : ascending) {
    mode.median = value;
    if (2 * (below += voxels) >= counted) break;
  }
  return mode;
}

BorderMode borderMode(VoxelSource& source) {
  const BorderMode mode = borderValues(source);
  if (mode.voxels == 1 && mode.border > 1)
    throw InvalidArgument(source.info().name +
                          ": background: expected a value that several voxels of the border have, "
                          "found " +
                          std::to_string(mode.different) + " different ones in " + std::to_string(mode.border) +
                          " finite voxels; give it as a number");
  return mode;
}

}  // namespace umbrick
