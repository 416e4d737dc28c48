// The light of a scene's visible bricks: computed where something changed, and in textures beside theirs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

#include "shade/light_textures.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/light/light_volume.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

class ResidentLight {
 public:
  /// @param volume  outlives this
  explicit ResidentLight(const Bricks& volume) : volume_(volume), light_(volume) {}

  /// Computes the light of a picture, where it is not there yet.
  /// @param planes  those that cut the medium, view coordinates
  /// @throw InvalidArgument  as LightVolume::update
  void update(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
              std::span<const glm::dvec4> planes, const BrickSelection& bricks);
  /// Brings the light of bricks to their textures. @param positions  in the selection; they are resident
  void require(const GlFunctions& gl, const BrickSelection& bricks, std::span<const std::int32_t> positions) {
    textures_.require(gl, bricks, light_, version_, positions);
  }

  const LightVolume& light() const { return light_; }
  /// @param index  that of the atlas's texture
  GLuint texture(int index) const { return textures_.texture(index); }
  void addTo(RenderStats& stats) const;

 private:
  const Bricks& volume_;
  LightVolume light_;
  LightTextures textures_;
  std::uint64_t version_ = 0;  // of the light
  double ms_ = 0;              // to compute it for the last picture
};

}  // namespace umbrick
