// Fields in bricks and pictures for tests of the renderer.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "support/field_bricks.h"
#include "support/gl_fixture.h"
#include "support/test_scenes.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

inline const RenderOptions kLayers{.visibilityAndDepth = true};
inline const IndexBox kBlock{glm::ivec3(0), glm::ivec3(31)};
/// Between voxels in each direction.
inline const Box kMediumIndex{glm::dvec3(2.3, 3.1, 2.7), glm::dvec3(28.6, 27.9, 28.2)};
inline constexpr glm::dvec3 kAlbedo(0.9, 0.5, 0.2);

/// Blobs that fade to nothing before the block ends, where slabs are drawn whole or not at all.
inline double blobs(const glm::ivec3& i) {
  const glm::dvec3 p(i);
  double value = 0;
  for (const glm::dvec4& blob : {glm::dvec4(11, 12, 20, 8), glm::dvec4(20, 19, 12, 9), glm::dvec4(18, 9, 16, 5)})
    value = std::max(value, 1 - glm::length(p - glm::dvec3(blob)) / blob.w);
  return value;
}
/// Both kinds, on the block.
inline std::vector<Camera> blobCameras() {
  return {orthographicCamera({45, 5, 40}, {16, 16, 16}, 40, 40), perspectiveCamera({36, 2, 38}, {16, 16, 16}, 0.8, 40)};
}

/// A field in bricks as the scene needs them.
inline FieldBricks fieldFor(const Scene& scene, FieldBricks::Field field, const IndexBox& box,
                            FieldOptions options = {}) {
  options.interior = scene.bricks.interior;
  options.apron = requiredApron(scene, options.indexToWorld);
  options.gradients = scene.transfer->is2d();
  return FieldBricks(std::move(field), box, options);
}

inline Picture renderPicture(const GlContext& context, const Bricks& volume, const Scene& scene,
                             const RenderOptions& options = {}) {
  return SliceRenderer(context, volume, scene, options).render();
}

}  // namespace umbrick
