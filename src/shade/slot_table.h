// Where the slots of bricks are, by cell of their lattice, as a texture that rays walk through.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "shade/ray_frame.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/gl/objects.h"

namespace umbrick {

/// What a table is made from.
struct SlotCells {
  std::span<const std::int32_t> positions;  // of bricks in the selection; they are resident
  CellBox cells;                            // those of the bricks, each in parts; see cellsAround
  glm::ivec3 parts{1};                      // of a brick along each axis
  std::span<const std::uint8_t> shown;      // by brick, then by part: whether there is anything to see
  std::span<const float> bounds;            // likewise: numbers that bounds() holds by cell; none: it is not made
  std::uint64_t version = 0;                // of `shown` and `bounds`
  bool joins = true;                        // a brick that shows something nearly everywhere is taken in one go
  std::vector<int> textures;                // that they lie in, see SlotTable::texturesOf
};

class SlotTable {
 public:
  /// A table of more cells than this is not made, nor one that is longer along an axis.
  static constexpr std::int64_t kMostCells = std::int64_t{1} << 23;
  static constexpr std::int64_t kMostEdge = 1024;
  static bool fits(const CellBox& cells);

  /// Returns the numbers of the atlas's textures that these bricks lie in, ascending. @pre they are resident
  static std::vector<int> texturesOf(const BrickSelection& bricks, std::span<const std::int32_t> positions);

  /// Takes the slots of bricks; does nothing where all is as at the last call.
  void fill(const GlFunctions& gl, const BrickSelection& bricks, const SlotCells& cells);
  GLuint texture() const { return texture_.name(); }
  /// R32F, by cell; what no cell of a brick is in has any number.
  GLuint bounds() const { return bounds_.name(); }
  std::uint64_t bytes() const;

 private:
  using Texel = std::array<std::uint16_t, 4>;
  /// What the texture was made from.
  struct Key {
    CellBox cells;
    std::uint64_t generation = 0;  // of the atlas
    std::uint64_t version = 0;
    glm::ivec3 parts{1};
    bool joins = true, bounds = false;
    std::vector<int> textures;
    std::vector<glm::ivec3> origins;  // by brick
    std::vector<std::int32_t> slots;
    bool operator==(const Key&) const = default;
  };
  void write(const BrickSelection& bricks, const SlotCells& cells);
  void measureDistances(const glm::ivec3& count);
  void upload(const GlFunctions& gl, const glm::ivec3& count);
  void uploadBounds(const GlFunctions& gl, const glm::ivec3& count);
  GlTexture texture_, bounds_;
  glm::ivec3 size_{0}, boundsSize_{0};
  Key held_;
  std::vector<Texel> texels_;
  std::vector<float> numbers_;  // of bounds_
};

}  // namespace umbrick
