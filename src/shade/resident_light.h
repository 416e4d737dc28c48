// The light of a scene's visible bricks: computed where something changed, and in textures beside theirs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shade/gl_light_sweep.h"
#include "shade/light_textures.h"
#include "umbrick/draw/renderer.h"
#include "umbrick/light/light_volume.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

class ResidentLight {
 public:
  /// @param resident  outlives this
  ResidentLight(ResidentVolume& resident, LightSweep sweep)
      : resident_(resident), sweep_(sweep), light_(resident.volume()) {}

  /// Computes the light of a picture, where it is not there yet. Where OpenGL computes it, all bricks are made
  /// resident.
  /// @param planes  those that cut the medium, view coordinates
  /// @throw InvalidArgument  as LightVolume::update
  void update(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
              std::span<const glm::dvec4> planes, const TransferLookup& transfer, BrickSelection& bricks);
  /// Computes the light of the surfaces of a picture, where it is not there yet. Bricks around the surfaces may have no
  /// medium, and those with medium may not be resident, so that the CPU sweeps it.
  /// @param planes  of the medium, view coordinates
  void updateSurfaces(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
                      std::span<const glm::dvec4> planes);
  /// Is called before the first update() of a picture: a picture of several stacks has as many.
  void beginPicture() { ms_ = 0; }
  /// Brings the light of bricks to their textures. @param positions  in the selection; they are resident
  void require(const GlFunctions& gl, const BrickSelection& bricks, std::span<const std::int32_t> positions) {
    if (!swept_) textures_.require(gl, bricks, light_, version_, positions);
  }

  /// Returns what arrives where nothing is in the way.
  const glm::dvec3& whole() const { return whole_; }
  bool coloured() const { return coloured_; }
  /// @param index  that of the atlas's texture
  GLuint texture(int index) const { return textures_.texture(index); }
  void addTo(RenderStats& stats) const;

 private:
  // What OpenGL computed the light in the textures for, and where the bricks were.
  struct Swept {
    LightMedium medium;
    std::uint64_t generation = 0;  // of the atlas
    std::vector<std::int32_t> slots;
    bool operator==(const Swept&) const = default;
  };
  void take(LightMedium& medium, const IndexView& view, std::span<const glm::dvec4> planes);
  bool sweepOnCpu(const LightMedium& medium, const ResolvedScene& scene);
  bool sweepOnGl(const LightMedium& medium, const TransferLookup& transfer, BrickSelection& bricks);
  bool wantsGl() const;
  ResidentVolume& resident_;
  const LightSweep sweep_;
  LightVolume light_;  // computed by the CPU
  GlLightSweep glSweep_;
  std::optional<Swept> swept_;  // none: the light is the CPU's
  std::string note_;            // see RenderStats::lightNote
  glm::dvec3 whole_{0};
  bool coloured_ = false;
  std::size_t directions_ = 0;
  LightTextures textures_;
  std::uint64_t version_ = 0;  // of the CPU's light
  double ms_ = 0;              // to compute it for the last picture
};

/// Binds the light beside textures of the atlas, as shaders/shade/light_share.glsl reads it.
/// @param textures  of the atlas
void bindLight(const GlFunctions& gl, const ResidentLight& light, std::span<const int> textures);

}  // namespace umbrick
