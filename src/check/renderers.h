// Renderers that live from one picture of a check to the next, so that bricks are uploaded and shaders compiled once.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <list>
#include <memory>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

class CheckRenderers {
 public:
  /// @param context      outlives this
  /// @param budgetBytes  of the textures of all volumes that are held
  /// @param options      of all renderers
  CheckRenderers(const GlContext& context, std::uint64_t budgetBytes, RenderOptions options)
      : context_(context), budgetBytes_(budgetBytes), options_(std::move(options)), resident_(context, budgetBytes) {}

  /// Returns a renderer of a scene, which may belong to other pictures of the same bricks; it holds until the next
  /// call. Those used longest ago leave where there is no room. @param bricks  outlives this
  SliceRenderer& get(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks = false);
  /// Returns one whose atlas has other limits, and holds no other pictures' bricks.
  SliceRenderer& get(const Bricks& bricks, const ResolvedScene& scene, const AtlasLimits& limits);
  /// Returns the volume that the first kind of them share.
  std::shared_ptr<ResidentVolume> volume(const Bricks& bricks, const ResolvedScene& scene) {
    return resident_.get(bricks, atlasOptions(scene, bricks));
  }
  /// Takes the renderer of these limits away, if there is one.
  void forget(const Bricks& bricks, const AtlasLimits& limits);

 private:
  struct Held {
    const Bricks* bricks;
    bool reverseBricks;
    AtlasLimits limits;
    std::shared_ptr<ResidentVolume> volume;
    std::unique_ptr<SliceRenderer> renderer;
    bool is(const Bricks& other, bool reverse, const AtlasLimits& others) const;
  };
  template <class MakeResident>
  SliceRenderer& find(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks, const AtlasLimits& limits,
                      const MakeResident& makeResident);
  void makeRoom();

  const GlContext& context_;
  std::uint64_t budgetBytes_;
  RenderOptions options_;
  ResidentVolumes resident_;
  std::list<Held> held_;  // used last first
};

}  // namespace umbrick
