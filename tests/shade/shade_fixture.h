// Fields in bricks and pictures for tests of the renderer.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

#include "support/field_bricks.h"
#include "support/gl_fixture.h"
#include "support/small_blobs.h"
#include "support/test_scenes.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

inline const RenderOptions kLayers{.visibilityAndDepth = true};
inline const IndexBox kBlock{glm::ivec3(0), glm::ivec3(31)};
/// A box in index coordinates whose faces lie between voxels in each direction.
inline const Box kMediumIndex{glm::dvec3(2.3, 3.1, 2.7), glm::dvec3(28.6, 27.9, 28.2)};
inline constexpr glm::dvec3 kAlbedo(0.9, 0.5, 0.2);

/// Returns a transfer function with nothing at the value `empty` and the full medium at `full`.
inline TransferFunction ramp(double sigma_t, double empty = 0, double full = 1) {
  const Medium nothing{kAlbedo, 0}, medium{kAlbedo, sigma_t};
  return empty < full ? TransferFunction({{empty, nothing}, {full, medium}})
                      : TransferFunction({{full, medium}, {empty, nothing}});
}

/// Blobs that fade to nothing before the block ends, where slabs are drawn whole or not at all.
inline double blobs(const glm::ivec3& i) { return coneAt(i, {{11, 12, 20, 8}, {20, 19, 12, 9}, {18, 9, 16, 5}}); }
/// Returns a parallel and a perspective camera that look at the block.
inline std::vector<Camera> blobCameras() {
  return {orthographicCamera({45, 5, 40}, {16, 16, 16}, 40, 40), perspectiveCamera({36, 2, 38}, {16, 16, 16}, 0.8, 40)};
}

/// Makes a field in bricks as the scene needs them.
inline FieldBricks fieldFor(const ResolvedScene& scene, FieldBricks::Field field, const IndexBox& box,
                            FieldOptions options = {}) {
  options.interior = scene.bricks.interior;
  options.apron = requiredApron(scene, options.indexToWorld);
  options.gradients = scene.transfer.is2d();
  return FieldBricks(std::move(field), box, options);
}

inline Picture renderPicture(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                             const RenderOptions& options = {}, const AtlasLimits& limits = {}) {
  return SliceRenderer(context, volume, scene, options, limits).render();
}

}  // namespace umbrick
