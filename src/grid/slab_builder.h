// Leaves out of a slab of dense voxels, on all cores.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "grid/sparse_rule.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Returns how many slices of a volume make a voxel slab: whole layers of leaves.
std::int64_t slabSlices(const glm::i64vec3& dims);

/// @throw IoError  two voxel slabs of so many slices do not fit into the machine's memory
void checkSlabFits(const VolumeInfo& info, std::int64_t slices);

/// One or more layers of leaves: the slices [firstSlice, firstSlice + slices), x fastest. Voxels are as the source
/// stores them where it can tell, else they are floats. The memory is kept from one slab to the next.
class VoxelSlab {
 public:
  explicit VoxelSlab(VoxelSource& source) : source_(source), type_(source.storedType().value_or(VoxelType::f32)) {}

  /// @param atMost  number of slices; fewer are read at the end of the volume, none behind it
  /// @return the largest error of the conversion to float
  /// @throw IoError  the source fails
  double read(std::int64_t firstSlice, std::int64_t atMost);

  /// Exchanges the voxels with another slab of the same source.
  void swap(VoxelSlab& other) {
    std::swap(firstSlice_, other.firstSlice_);
    std::swap(slices_, other.slices_);
    std::swap(bytes_, other.bytes_);
    std::swap(capacity_, other.capacity_);
  }

  std::int64_t firstSlice() const { return firstSlice_; }
  std::int64_t slices() const { return slices_; }
  VoxelType type() const { return type_; }
  /// Returns the voxels; T must be the type that type() names.
  template <class T>
  const T* voxels() const {
    return reinterpret_cast<const T*>(bytes_.get());
  }

 private:
  VoxelSource& source_;
  VoxelType type_;
  std::int64_t firstSlice_ = 0, slices_ = 0;
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t capacity_ = 0;
};

class SlabBuilder {
 public:
  SlabBuilder(const glm::i64vec3& dims, const SparseRule& rule);

  /// Builds the leaves of a slab and adds them to the tree.
  SparseTally addTo(openvdb::FloatTree& tree, const VoxelSlab& slab);

 private:
  // What stands in the place of one leaf; with neither it is background.
  struct Place {
    std::unique_ptr<Leaf> leaf;
    std::optional<float> tile;
  };

  template <class T>
  SparseTally build(const VoxelSlab& slab);
  template <class T>
  Place buildLeaf(const T* voxels, const VoxelSlab& slab, const openvdb::Coord& at, SparseTally& tally) const;
  openvdb::Coord origin(std::size_t place, const VoxelSlab& slab) const;

  glm::i64vec3 dims_;
  const SparseRule& rule_;
  std::int64_t leavesX_, leavesY_;
  std::vector<Place> places_;
};

}  // namespace umbrick
