// Bricks as blocks of 3D textures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"
#include "umbrick/gl/objects.h"

namespace umbrick {

struct AtlasOptions {
  VoxelFormat format = VoxelFormat::float32;
  std::uint64_t budgetBytes = std::uint64_t{2} << 30;        // of all textures together
  std::uint64_t maxTextureBytes = std::uint64_t{512} << 20;  // of one texture; software drivers refuse more than 1 GiB
  int maxTextureEdge = 0;                                    // texels; 0 takes what the driver allows
};

/// Whether bricks of one value may share a slot. They may not where something lies beside each slot that differs from
/// brick to brick, such as light.
enum class SlotSharing { shared, apart };

/// How texels are turned into grid values: value = offset + texel * scale, where a texel is what a shader reads.
struct TexelScale {
  double scale = 1, offset = 0;
  /// Grid units: the largest |voxel - texel| that the format may cause; 0 when the format is exact.
  double rounding = 0;
  double toTexel(double value) const { return (value - offset) / scale; }
};

/// Returns how an atlas of this format stores the values of a volume. Whole numbers are stored as they are where they
/// fit. In a fixed-point format other values are spread over the codes. 32-bit floats hold the distance
/// from volume.anchor.
TexelScale texelScale(const Bricks& volume, VoxelFormat format);

/// Returns what a shader reads where all voxels have this value, up to a rounding. @param scale  that of the format
double texelOf(float value, const TexelScale& scale, VoxelFormat format);
/// Returns the same for a gradient magnitude, which no fixed-point format holds.
double gradientTexelOf(float gradient, VoxelFormat format);

/// A pool of slots, all in textures of one size, filled as bricks are required. When every brick fits, each is uploaded
/// once; else those that were required longest ago make room. Bricks of one value share a slot. The pool grows when
/// more bricks are to be held; what is resident is copied on the GPU, not uploaded again, where the budget has room for
/// both pools meanwhile.
class BrickAtlas {
 public:
  struct Slot {
    int texture = 0;
    glm::ivec3 origin{0};  // first apron voxel, in texels
  };

  /// A pool for all of these.
  /// @param bricks  those that may be required, by their position in the list
  /// @throw InvalidArgument  not even one brick fits the budget or a texture: says what is needed and what there is
  /// @throw GlError
  BrickAtlas(const GlContext& context, const Bricks& volume, std::vector<Brick> bricks, const AtlasOptions& options);

  /// An empty pool for bricks of the volume; reserve() makes room.
  /// @throw InvalidArgument  as above
  BrickAtlas(const GlContext& context, const Bricks& volume, const AtlasOptions& options);

  BrickAtlas(const BrickAtlas&) = delete;  // selections and renderers point to it
  BrickAtlas& operator=(const BrickAtlas&) = delete;

  /// Returns how many slots these bricks take.
  std::size_t slotsFor(std::span<const std::int32_t> bricks, SlotSharing sharing = SlotSharing::shared) const;
  /// Makes room for so many slots, or for as many as the budget allows.
  /// @throw GlError
  void reserve(std::size_t slots);
  /// More bricks that may be required, behind those there are.
  void append(const std::vector<Brick>& bricks);

  /// Makes bricks resident, those that are not yet. Others stay as long as there is room.
  /// @param sharing  apart: afterwards none of them has the same slot as another brick
  /// @throw InvalidArgument  more slots are needed than the budget allows: names both sizes
  void require(std::span<const std::int32_t> bricks, SlotSharing sharing = SlotSharing::shared);
  /// Gives the slot of a brick back.
  void release(std::int32_t brick);

  bool isResident(std::int32_t brick) const { return slotOf_[static_cast<std::size_t>(brick)] >= 0; }
  Slot slot(std::int32_t brick) const;  // the brick must be resident
  GLuint texture(int index) const { return textures_[static_cast<std::size_t>(index)].name(); }
  int textureCount() const { return static_cast<int>(textures_.size()); }
  glm::ivec3 textureSize() const { return plan_.size; }
  TexelScale valueScale() const { return valueScale_; }
  double texelOf(float value) const { return umbrick::texelOf(value, valueScale_, format_); }
  const std::vector<Brick>& bricks() const { return bricks_; }
  const BrickLayout& layout() const { return volume_.layout; }
  std::size_t slots() const { return slots_; }
  /// Returns the number of a brick's slot, below slots(); the brick must be resident.
  std::int32_t slotNumber(std::int32_t brick) const { return slotOf_[static_cast<std::size_t>(brick)]; }
  /// Returns a number that grows whenever the textures are made anew and slots lie elsewhere in them.
  std::uint64_t generation() const { return generation_; }
  bool holdsAll() const { return slots_ >= slotsForAll_; }
  std::uint64_t textureBytes() const;
  std::uint64_t uploadedBricks() const { return uploaded_; }
  /// Returns the largest difference between a voxel and its texel so far, grid units; 0 for an exact format.
  double formatError() const { return formatError_; }

 private:
  using UniformKey = std::tuple<float, float, float>;
  void checkLimits(int maxEdge);
  // How slots are arranged.
  struct Plan {
    glm::ivec3 slotGrid{1}, size{0};  // slots along each axis of a texture, and its texels
  };
  Plan planTextures(std::size_t slots) const;
  void clear();
  void evict(std::size_t slots);
  bool mayShare(std::int32_t brick, SlotSharing sharing) const;
  void setApart(std::int32_t brick);
  std::uint64_t slotBytes() const;
  Slot place(std::int32_t slot, const glm::ivec3& slotGrid) const;
  void upload(std::span<const std::pair<std::int32_t, std::int32_t>> brickAndSlot);

  const GlFunctions& gl_;
  const Bricks& volume_;
  std::vector<Brick> bricks_;
  VoxelFormat format_;
  TexelScale valueScale_;
  Plan plan_;
  std::size_t slots_ = 0, slotsForAll_ = 0, affordable_ = 0;
  AtlasOptions options_;
  int maxEdge_ = 0;  // texels, of a texture
  std::vector<GlTexture> textures_;
  std::vector<std::int32_t> slotOf_;            // by brick, -1 when not resident
  std::vector<std::int32_t> users_;             // by slot
  std::vector<std::uint64_t> requiredAt_;       // by slot: the number of the call of require() that asked for it last
  std::uint64_t requests_ = 0;                  // calls of require()
  std::vector<std::int32_t> free_;              // slots
  std::map<UniformKey, std::int32_t> uniform_;  // slots of bricks of one value
  std::uint64_t uploaded_ = 0, generation_ = 0;
  double formatError_ = 0;
};

/// Returns the format of a name; "auto" takes what the volume needs.
/// @throw InvalidArgument  an unknown name, or a format that cannot hold the volume's gradient magnitudes
VoxelFormat parseVoxelFormat(const std::string& name, const Bricks& volume);
std::string voxelFormatName(VoxelFormat format);

}  // namespace umbrick
