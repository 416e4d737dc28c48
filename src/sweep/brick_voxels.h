// The voxels of visible bricks in memory, as the CPU's renderers read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "sweep/medium_table.h"
#include "umbrick/brick/bricks.h"

namespace umbrick {

/// A row or a slice this near to voxels lies on them.
inline constexpr double kOnVoxels = 1e-9;

/// How a voxel is stored.
enum class VoxelCode { u8, u16, f32 };

/// The voxels of one brick with its apron, x fastest, and what is known of them.
struct VoxelBrick {
  glm::ivec3 origin{0};  // first owned voxel
  Range value, gradient;
  std::unique_ptr<std::byte[]> voxels;     // codes; none where all are the same
  std::unique_ptr<float[]> gradients;      // grid units per world unit; of 2D functions alone
  std::unique_ptr<std::uint16_t[]> light;  // shares of lightUnit(), by channel; none without a light volume
  /// The range of the voxels of each group of cells, and whether the function shows anything in it.
  std::unique_ptr<float[]> ranges;
  std::vector<std::uint8_t> active;
};

/// A brick of a volume, whether it is held or not.
struct PlacedBrick {
  glm::ivec3 origin{0};               // first owned voxel
  const VoxelBrick* brick = nullptr;  // none: nothing of it is visible, so that its voxels are not held
  float value = 0;                    // then: a value that it has
};

/// Holds the bricks that a transfer function shows. A cell is the space between eight voxels; a brick has the cells
/// that begin at its owned voxels and at the layer of ghost voxels before them. Cells come in groups of kGroup along
/// each axis, counted from the first owned voxel; the layer before belongs to the first groups.
class BrickVoxels {
 public:
  static constexpr int kGroup = 4;
  /// Arrays of voxels end with so many more, so that loops may read several at once.
  static constexpr std::size_t kPadding = 32;
  /// @param volume  outlives this
  explicit BrickVoxels(const Bricks& volume);

  /// Holds the bricks that the function shows and lets others go. Where this throws, nothing has changed.
  /// @throw InvalidArgument  more than `mostBytes`
  /// @param culling  false: all bricks are held, and all groups are active
  void select(const MediumTable& table, bool culling, bool backgroundVisible, std::uint64_t mostBytes);

  /// Does the same for pictures that do not look at a transfer function: holds the bricks and marks the groups whose
  /// range of values is wanted.
  void select(const std::function<bool(const Range& value)>& isWanted, std::uint64_t mostBytes);

  const Bricks& volume() const { return volume_; }
  VoxelCode code() const { return code_; }
  /// value = offset() + code
  double offset() const { return offset_; }
  std::span<const std::unique_ptr<VoxelBrick>> bricks() const { return bricks_; }
  /// Returns those and all others of the volume, of which no more than a value is known.
  std::vector<PlacedBrick> allBricks() const;
  VoxelBrick& brick(std::size_t i) { return *bricks_[i]; }
  std::uint64_t bytes() const;
  std::uint64_t loaded() const { return loaded_; }  // bricks that were read for the last selection
  glm::ivec3 groups() const { return groups_; }
  /// A number that grows whenever the bricks that are held change.
  std::uint64_t generation() const { return generation_; }

  /// Codes of one type. @pre code() is that type's, and the brick has voxels
  template <class Code>
  static const Code* codes(const VoxelBrick& brick) {
    return reinterpret_cast<const Code*>(brick.voxels.get());
  }

 private:
  void hold(std::vector<Brick> wanted, bool gradients, std::uint64_t mostBytes,
            const std::function<void(VoxelBrick&)>& mark);
  std::size_t groupCount() const;
  void load(VoxelBrick& brick, std::vector<float>& values) const;
  template <class Code>
  void store(VoxelBrick& brick, std::span<const float> values) const;
  void findRanges(VoxelBrick& brick, std::span<const float> values) const;
  void activate(VoxelBrick& brick, const MediumTable& table, bool culling) const;

  const Bricks& volume_;
  VoxelCode code_ = VoxelCode::f32;
  double offset_ = 0;
  glm::ivec3 groups_{1};
  std::vector<std::unique_ptr<VoxelBrick>> bricks_;  // ascending in z, then y, then x
  std::uint64_t loaded_ = 0, generation_ = 0;
};

}  // namespace umbrick
