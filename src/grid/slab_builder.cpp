// SPDX-License-Identifier: Apache-2.0
#include "grid/slab_builder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iomanip>
#include <limits>
#include <span>
#include <sstream>
#include <type_traits>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::int64_t kSlabVoxels = std::int64_t(1) << 21;  // enough work for all cores, little enough for caches

// Returns the background as it is stored, or nothing where the type cannot hold it and so no voxel can equal it.
template <class T>
std::optional<T> storedBackground(float background) {
  if constexpr (std::is_same_v<T, float>) {
    return background;
  } else {
    using Limits = std::numeric_limits<T>;
    if (background < static_cast<float>(Limits::lowest()) || background > static_cast<float>(Limits::max()))
      return std::nullopt;
    const T stored = static_cast<T>(background);
    return static_cast<float>(stored) == background ? std::optional(stored) : std::nullopt;
  }
}

// Finds which leaves in one row of leaves hold anything but background, before any voxel becomes a float. In a sparse
// volume most leaves are decided here, so voxels are read in the order of memory, eight at a time.
template <class T>
class RowTest {
 public:
  explicit RowTest(T background) : background_(background) {
    std::array<T, kLeafEdge> row;
    row.fill(background);
    std::memcpy(pattern_.data(), row.data(), sizeof row);
  }

  void include(const T* row, std::span<std::uint64_t> differs, std::int64_t dimX) const {
    const std::int64_t whole = dimX / kLeafEdge;
    for (std::int64_t leaf = 0; leaf < whole; ++leaf) {
      std::array<std::uint64_t, sizeof(T)> words;
      std::memcpy(words.data(), row + leaf * kLeafEdge, sizeof words);
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < words.size(); ++i) bits |= words[i] ^ pattern_[i];
      differs[static_cast<std::size_t>(leaf)] |= bits;
    }
    for (std::int64_t x = whole * kLeafEdge; x < dimX; ++x)
      differs[static_cast<std::size_t>(whole)] |= static_cast<std::uint64_t>(row[x] != background_);
  }

 private:
  T background_;
  std::array<std::uint64_t, sizeof(T)> pattern_;
};

}  // namespace

std::int64_t slabSlices(const glm::i64vec3& dims) {
  return std::max<std::int64_t>(kSlabVoxels / (dims.x * dims.y) / kLeafEdge, 1) * kLeafEdge;
}

// A header may promise slices of any size, and the length of a packed file cannot tell whether that is true.
void checkSlabFits(const VolumeInfo& info, std::int64_t slices) {
  const double wanted = 2 * double(info.dims.x) * double(info.dims.y) * double(slices) * double(sizeof(float));
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (wanted <= memory) return;
  std::ostringstream text;
  text << std::setprecision(4) << info.name << ": dims: two slabs of " << info.dims.x << " x " << info.dims.y << " x "
       << slices << " voxels take " << wanted / 0x1p30 << " GiB, more than this machine's memory of "
       << memory / 0x1p30;
  throw IoError(text.str());
}

double VoxelSlab::read(std::int64_t firstSlice, std::int64_t atMost) {
  const glm::i64vec3& dims = source_.info().dims;
  firstSlice_ = firstSlice;
  slices_ = std::clamp<std::int64_t>(dims.z - firstSlice, 0, atMost);
  if (slices_ == 0) return 0;
  const auto voxels = static_cast<std::size_t>(slices_ * dims.x * dims.y);
  const std::size_t bytes = voxels * static_cast<std::size_t>(voxelBytes(type_));
  if (bytes > capacity_) {
    bytes_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
    capacity_ = bytes;
  }
  if (!source_.storedType()) return source_.readSlab(slices_, {reinterpret_cast<float*>(bytes_.get()), voxels});
  source_.readStored(slices_, {bytes_.get(), bytes});
  return 0;
}

SlabBuilder::SlabBuilder(const glm::i64vec3& dims, const SparseRule& rule)
    : dims_(dims),
      rule_(rule),
      leavesX_((dims.x + kLeafEdge - 1) / kLeafEdge),
      leavesY_((dims.y + kLeafEdge - 1) / kLeafEdge) {}

SparseTally SlabBuilder::addTo(openvdb::FloatTree& tree, const VoxelSlab& slab) {
  places_.clear();
  places_.resize(static_cast<std::size_t>(leavesX_ * leavesY_ * ((slab.slices() + kLeafEdge - 1) / kLeafEdge)));
  const SparseTally tally = [&] {
    switch (slab.type()) {
      case VoxelType::u8:
        return build<std::uint8_t>(slab);
      case VoxelType::i8:
        return build<std::int8_t>(slab);
      case VoxelType::u16:
        return build<std::uint16_t>(slab);
      case VoxelType::i16:
        return build<std::int16_t>(slab);
      default:
        return build<float>(slab);
    }
  }();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].leaf)
      tree.addLeaf(places_[i].leaf.release());
    else if (places_[i].tile)
      tree.addTile(1, origin(i, slab), *places_[i].tile, true);
  }
  return tally;
}

template <class T>
SparseTally SlabBuilder::build(const VoxelSlab& slab) {
  const T* voxels = slab.voxels<T>();
  const std::optional<T> background = storedBackground<T>(rule_.background());
  const std::optional<RowTest<T>> test = background ? std::optional(RowTest<T>(*background)) : std::nullopt;
  const auto leavesX = static_cast<std::size_t>(leavesX_);
  const std::size_t grain = std::max<std::size_t>(16 / leavesX, 1);
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, places_.size() / leavesX, grain), SparseTally{},
      [&](const tbb::blocked_range<std::size_t>& rows, SparseTally sum) {
        std::vector<std::uint64_t> differs(leavesX, 1);
        for (std::size_t row = rows.begin(); row != rows.end(); ++row) {
          const std::size_t first = row * leavesX;
          if (test) {
            const openvdb::Coord at = origin(first, slab);
            const std::int64_t endZ = std::min<std::int64_t>(at.z() + kLeafEdge, slab.firstSlice() + slab.slices());
            const std::int64_t endY = std::min<std::int64_t>(at.y() + kLeafEdge, dims_.y);
            std::fill(differs.begin(), differs.end(), 0);
            for (std::int64_t z = at.z(); z < endZ; ++z)
              for (std::int64_t y = at.y(); y < endY; ++y)
                test->include(voxels + ((z - slab.firstSlice()) * dims_.y + y) * dims_.x, differs, dims_.x);
          }
          for (std::size_t i = 0; i < leavesX; ++i)
            if (differs[i] != 0) places_[first + i] = buildLeaf(voxels, slab, origin(first + i, slab), sum);
        }
        return sum;
      },
      [](SparseTally a, const SparseTally& b) {
        a.add(b);
        return a;
      });
}

template <class T>
SlabBuilder::Place SlabBuilder::buildLeaf(const T* slabVoxels, const VoxelSlab& slab, const openvdb::Coord& at,
                                          SparseTally& tally) const {
  LeafVoxels voxels;
  const auto nx = static_cast<int>(std::min<std::int64_t>(kLeafEdge, dims_.x - at.x()));
  const auto ny = static_cast<int>(std::min<std::int64_t>(kLeafEdge, dims_.y - at.y()));
  const auto nz = static_cast<int>(std::min<std::int64_t>(kLeafEdge, slab.firstSlice() + slab.slices() - at.z()));
  if (nx < kLeafEdge || ny < kLeafEdge || nz < kLeafEdge) {  // some of the leaf lies beyond the volume
    std::fill(std::begin(voxels.value), std::end(voxels.value), rule_.background());
    for (int x = 0; x < nx; ++x)
      for (int y = 0; y < ny; ++y)
        for (int z = 0; z < nz; ++z) voxels.active.setOn(static_cast<openvdb::Index>((x << 6) | (y << 3) | z));
  } else {
    voxels.active.setOn();
  }
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y) {
      const T* row = slabVoxels + ((at.z() - slab.firstSlice() + z) * dims_.y + at.y() + y) * dims_.x + at.x();
      for (int x = 0; x < nx; ++x) voxels.value[(x << 6) | (y << 3) | z] = static_cast<float>(row[x]);
    }
  Place place;
  place.tile = rule_.apply(voxels, tally);
  if (place.tile || voxels.active.isOff()) return place;
  place.leaf = std::make_unique<Leaf>(at, rule_.background());
  std::copy(std::begin(voxels.value), std::end(voxels.value), place.leaf->buffer().data());
  place.leaf->setValueMask(voxels.active);
  return place;
}

openvdb::Coord SlabBuilder::origin(std::size_t place, const VoxelSlab& slab) const {
  const auto i = static_cast<std::int64_t>(place);
  return openvdb::Coord(static_cast<int>(i % leavesX_ * kLeafEdge),
                        static_cast<int>(i / leavesX_ % leavesY_ * kLeafEdge),
                        static_cast<int>(slab.firstSlice() + i / (leavesX_ * leavesY_) * kLeafEdge));
}

}  // namespace umbrick
