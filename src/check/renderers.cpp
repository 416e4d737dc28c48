// SPDX-License-Identifier: Apache-2.0
#include "check/renderers.h"

#include <algorithm>
#include <set>

namespace umbrick {

bool CheckRenderers::Held::is(const Bricks& other, bool reverse, const AtlasLimits& others) const {
  return bricks == &other && reverseBricks == reverse && limits.budgetBytes == others.budgetBytes &&
         limits.maxTextureBytes == others.maxTextureBytes && limits.maxTextureEdge == others.maxTextureEdge;
}

SliceRenderer& CheckRenderers::get(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks) {
  return find(bricks, scene, reverseBricks, {}, [&] { return resident_.get(bricks, atlasOptions(scene, bricks)); });
}

SliceRenderer& CheckRenderers::get(const Bricks& bricks, const ResolvedScene& scene, const AtlasLimits& limits) {
  return find(bricks, scene, false, limits,
              [&] { return std::make_shared<ResidentVolume>(context_, bricks, atlasOptions(scene, bricks, limits)); });
}

void CheckRenderers::forget(const Bricks& bricks, const AtlasLimits& limits) {
  std::erase_if(held_, [&](const Held& one) { return one.is(bricks, false, limits); });
}

template <class MakeResident>
SliceRenderer& CheckRenderers::find(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks,
                                    const AtlasLimits& limits, const MakeResident& makeResident) {
  const auto found =
      std::find_if(held_.begin(), held_.end(), [&](const Held& one) { return one.is(bricks, reverseBricks, limits); });
  if (found != held_.end()) {
    held_.splice(held_.begin(), held_, found);
    found->renderer->setScene(scene);
    return *found->renderer;
  }
  makeRoom();
  RenderOptions options = options_;
  options.reverseBricks = reverseBricks;
  Held made{&bricks, reverseBricks, limits, makeResident(), nullptr};
  made.renderer = std::make_unique<SliceRenderer>(*made.volume, scene, options);
  return *held_.emplace_front(std::move(made)).renderer;
}

// What a new one will take is not known yet: half of the budget is left for it.
void CheckRenderers::makeRoom() {
  const auto bytes = [&] {
    std::set<const ResidentVolume*> volumes;
    std::uint64_t sum = 0;
    for (const Held& one : held_)
      if (volumes.insert(one.volume.get()).second) sum += one.volume->atlas().textureBytes();
    return sum;
  };
  while (!held_.empty() && bytes() > budgetBytes_ / 2) held_.pop_back();
}

}  // namespace umbrick
