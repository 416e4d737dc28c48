// Progressive pictures by slices, of a volume that is made resident for one or shared by several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "umbrick/draw/progressive.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

using OnPass = std::function<bool(const ProgressivePicture&)>;

inline ProgressivePicture progressiveSlices(ResidentVolume& volume, const ResolvedScene& scene,
                                            const ProgressiveOptions& options, const RenderOptions& render = {},
                                            const OnPass& onPass = {}) {
  SliceRenderer renderer(volume, scene, render);
  return renderProgressive(renderer, options, onPass);
}

inline ProgressivePicture progressiveSlices(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                                            const ProgressiveOptions& options, const RenderOptions& render = {},
                                            const OnPass& onPass = {}) {
  SliceRenderer renderer(context, volume, scene, render);
  return renderProgressive(renderer, options, onPass);
}

}  // namespace umbrick
