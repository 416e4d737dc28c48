// Computes light volumes with compute shaders, from voxels that are resident straight into the textures of light.
//
// The recurrence is that of umbrick/light/light_volume.h and its numbers are the CPU's: the same paths, the same table
// of the transfer function, the same formula where planes cut the medium. Paths do not meet each other, so a slab of
// slices is taken at once:
//
//     light      \    \    \        light_blocks.comp   once: which blocks of voxels get light
//     ======slab of 8 slices====    light_carry.comp    paths through the slab: depths, and transmittances on each
//     slice
//                 \    \    \       light_add.comp      voxels of the slab's blocks take the mean of paths around them
//     ======the next one========    ...
//
// Directions of one side go together, up to 16 of them. Which tiles of paths are followed through a slab, and which
// blocks get light, are lists that the CPU makes from the blocks (light_slabs.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "shade/frame.h"
#include "shade/light_slabs.h"
#include "shade/light_textures.h"
#include "shade/slot_table.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/light/extinction_table.h"
#include "umbrick/light/light_volume.h"

namespace umbrick {

class GlLightSweep {
 public:
  /// Tells why light of a medium cannot be computed here, in words that go on after "light is computed on the CPU: ";
  /// empty where it can.
  static std::string refusal(const ResidentVolume& resident, const BrickSelection& bricks, const LightMedium& medium);

  /// Adds the light of all of a medium. @param transfer  that of the medium, of a 2D function; light  has textures for
  /// the atlas that hold 0
  /// @pre the bricks are resident, each in a slot of its own, and nothing speaks against it  @throw GlError
  void sweep(const ResidentVolume& resident, const BrickSelection& bricks, const LightMedium& medium,
             const TransferLookup& transfer, const LightTextures& light);

  /// Returns how many texels of paths were taken through a slice.
  std::uint64_t updates() const { return updates_; }
  /// Returns the bytes of buffers, which are kept for the next sweep.
  std::uint64_t bytes() const;

 private:
  // A buffer with the size that it has.
  struct Buffer {
    GlBuffer buffer;
    std::uint64_t bytes = 0;
  };
  // What the parts of one sweep share.
  struct Volume;
  void fill(Buffer& buffer, GLuint unit, std::uint64_t bytes, const void* data);
  void makeTables(const Volume& volume);
  LitBricks findBlocks(const Volume& volume);
  void sweepSide(const Volume& volume, const LightSlabs& slabs, const glm::i64vec3& first, const SweepSide& side);
  void sweepTogether(const Volume& volume, const LightSlabs& slabs, const glm::i64vec3& first,
                     std::span<const SweptDirection> directions);
  void setPlace(GlProgram& program, const Volume& volume, const LightSlabs& slabs) const;

  const GlFunctions* gl_ = nullptr;
  SlotTable slots_;
  SpecialisedProgram blocksProgram_{"shade/light_blocks.comp"}, carryProgram_{"shade/light_carry.comp"},
      addProgram_{"shade/light_add.comp"};
  Buffer table_, bricks_, lit_, blocks_, tiles_, places_, directions_, depths_, through_;
  std::uint64_t updates_ = 0;
};

}  // namespace umbrick
