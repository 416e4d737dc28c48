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

/// How a voxel is stored: as a whole number above the least one, or as a float of 16 or 32 bits.
enum class VoxelCode { u8, u16, f16, f32 };
inline bool isFloat(VoxelCode code) { return code == VoxelCode::f16 || code == VoxelCode::f32; }

/// A 16-bit float of a voxel.
struct HalfCode {
  std::uint16_t bits = 0;
};
static_assert(sizeof(HalfCode) == 2);
float halfValue(HalfCode code);

/// A medium as renderers integrate it: sigma_t, then sigma_s of red, green and blue, 1/world unit.
inline constexpr int kMediumNumbers = 4;

/// The voxels of one brick with its apron, x fastest, and what is known of them.
struct VoxelBrick {
  glm::ivec3 origin{0};  // first owned voxel
  Range value, gradient;
  std::unique_ptr<std::byte[]> voxels;     // codes; none where all are the same
  std::unique_ptr<float[]> gradients;      // grid units per world unit; of 2D functions alone
  std::unique_ptr<float[]> media;          // sigma_t and sigma_s by colour, each of all voxels; see classify()
  std::unique_ptr<std::uint16_t[]> light;  // shares of lightUnit(), by channel; none without a light volume
  Range emissionRange{0, 0};
  bool readEmission = false;          // whether that of the second grid was asked for
  std::unique_ptr<float[]> emission;  // values of the second grid; none where all are the same
  /// The range of the voxels of each group of cells, and whether the function shows anything in it.
  std::unique_ptr<float[]> ranges, emissionRanges;
  std::vector<std::uint8_t> active;
};

/// A brick of a volume, whether it is held or not.
struct PlacedBrick {
  glm::ivec3 origin{0};               // first owned voxel
  const VoxelBrick* brick = nullptr;  // none: nothing of it is visible, so that its voxels are not held
  float value = 0, emission = 0;      // then: a value that it has, of each grid
};

/// What a scene shows of values: the functions of the grid and of the second one, where that emits.
struct ShownValues {
  const MediumTable& medium;
  const MediumTable* emission = nullptr;
  // NOLINTNEXTLINE(google-explicit-constructor): a medium alone is what most scenes show
  ShownValues(const MediumTable& table, const MediumTable* emits = nullptr) : medium(table), emission(emits) {}
  bool shows(const Range& value, const Range& gradient, const Range& emitted) const {
    return !medium.isTransparent(value, gradient) || (emission && !emission->isTransparent(emitted, {0, 0}));
  }
};

/// Holds the bricks that a transfer function shows. A cell is the space between eight voxels; a brick has the cells
/// that begin at its owned voxels and at the layer of ghost voxels before them. Cells come in groups of kGroup along
/// each axis, counted from the first owned voxel; the layer before belongs to the first groups.
class BrickVoxels {
 public:
  static constexpr int kGroup = 4;
  /// Arrays of voxels end with so many more, so that loops may read several at once.
  static constexpr std::size_t kPadding = 32;
  /// @param volume  outlives this  @param halves  whether floats may be held in 16 bits, where that is exact
  explicit BrickVoxels(const Bricks& volume, bool halves = true);

  /// Returns the bricks that the function shows, ascending in z, then y, then x.
  /// @param culling  false: all bricks
  std::vector<Brick> visible(const ShownValues& shown, bool culling, bool backgroundVisible) const;
  /// Returns what the voxels of bricks take, and of one of several values. Bricks of one value take none.
  /// @param gradients  whether they are held, too, as for 2D functions; emission: the same of the second grid
  std::uint64_t bytesOf(std::span<const Brick> bricks, bool gradients, bool emission = false) const;
  std::uint64_t bytesEach(bool gradients, bool emission = false) const;
  /// Holds bricks and lets others go. Where this throws, nothing has changed.
  /// @param wanted    some of those that visible() returns, in its order
  /// @param culling   false: all groups are active
  /// @param makeRoom  lets others go first, so that no more is held at any time; they are gone where this throws
  void hold(std::span<const Brick> wanted, const ShownValues& shown, bool culling, bool makeRoom = false);

  /// Does the same for pictures that do not look at a transfer function: holds the bricks and marks the groups whose
  /// range of values is wanted.
  void select(const std::function<bool(const Range& value)>& isWanted, std::uint64_t mostBytes);

  const Bricks& volume() const { return volume_; }
  VoxelCode code() const { return code_; }
  /// value = offset() + code; floats are values by themselves
  double offset() const { return offset_; }
  std::span<const std::unique_ptr<VoxelBrick>> bricks() const { return bricks_; }
  /// Returns those and all others of the volume, of which no more than a value is known.
  std::vector<PlacedBrick> allBricks() const;
  VoxelBrick& brick(std::size_t i) { return *bricks_[i]; }
  std::uint64_t bytes() const;
  std::uint64_t loaded() const { return loaded_; }  // bricks that were read by the last hold()
  glm::ivec3 groups() const { return groups_; }
  /// A number that grows whenever the bricks that are held change.
  std::uint64_t generation() const { return generation_; }

  /// Codes of one type. @pre code() is that type's, and the brick has voxels
  template <class Code>
  static const Code* codes(const VoxelBrick& brick) {
    return reinterpret_cast<const Code*>(brick.voxels.get());
  }

 private:
  void read(std::span<const Brick> wanted, bool gradients, bool emission);
  std::size_t groupCount() const;
  void load(VoxelBrick& brick, std::vector<float>& values) const;
  template <class Code>
  void store(VoxelBrick& brick, std::span<const float> values) const;
  void loadEmission(VoxelBrick& brick) const;
  std::unique_ptr<float[]> rangesOf(std::span<const float> values) const;
  void activate(VoxelBrick& brick, const ShownValues& shown, bool culling) const;

  const Bricks& volume_;
  VoxelCode code_ = VoxelCode::f32;
  double offset_ = 0;
  glm::ivec3 groups_{1};
  std::vector<std::unique_ptr<VoxelBrick>> bricks_;  // ascending in z, then y, then x
  std::uint64_t loaded_ = 0, generation_ = 0;
};

}  // namespace umbrick
