// The light of resident bricks, in textures of their own with the slots of the atlas.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/gl/objects.h"
#include "umbrick/light/light_volume.h"

namespace umbrick {

class LightTextures {
 public:
  /// Brings the light of bricks up to date that are resident, each in a slot of its own.
  /// @param version   of the light; a brick's light is uploaded again only for another one
  /// @param positions  of the bricks in the selection
  void require(const GlFunctions& gl, const BrickSelection& bricks, const LightVolume& light, std::uint64_t version,
               std::span<const std::int32_t> positions);
  /// Makes textures for the atlas in which all light is 0, and forgets what they held.
  void clear(const GlFunctions& gl, const BrickAtlas& atlas, int channels);
  GLuint texture(int index) const { return textures_[static_cast<std::size_t>(index)].name(); }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t uploadedBricks() const { return uploaded_; }

 private:
  void makeTextures(const GlFunctions& gl, const BrickAtlas& atlas, int channels);
  // What a slot holds.
  struct Held {
    std::int32_t position = -1;
    std::uint64_t version = 0;
    bool operator==(const Held&) const = default;
  };
  std::vector<GlTexture> textures_;
  std::vector<Held> held_;  // by slot
  const BrickAtlas* atlas_ = nullptr;
  std::uint64_t generation_ = 0;  // of the atlas's textures, when these were made
  int channels_ = 0;
  std::uint64_t bytes_ = 0, uploaded_ = 0;
};

}  // namespace umbrick
