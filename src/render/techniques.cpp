// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/techniques.h"

#include <algorithm>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/ray_caster.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/sweep/ray_renderer.h"
#include "umbrick/sweep/shear_warp_renderer.h"

namespace umbrick {
namespace {

template <class Kind>
std::unique_ptr<Renderer> makeOnGl(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options) {
  return std::make_unique<Kind>(volume, scene, options);
}

template <class Kind>
std::unique_ptr<Renderer> makeOnCpu(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options) {
  return std::make_unique<Kind>(volume, scene, options);
}

bool slicesSupport(const SceneSettings& scene) {
  return supportsMode(scene, Technique::slices) && supports(scene.method, scene.model) &&
         occlusionMethod(scene) != Method::coneRays && scene.sampling.classification == Classification::post;
}

bool stacksSupport(const SceneSettings& scene) {
  const std::optional<Method> method = occlusionMethod(scene);
  return supportsMode(scene, Technique::stacks) && (!method || *method == Method::lightVolume) &&
         scene.sampling.classification == Classification::post;
}

// A new technique is a new row of this table.
constexpr TechniqueTraits kTraits[]{
    {Technique::slices, "proxy slices across the view, nearest first", makeOnGl<SliceRenderer>, nullptr, slicesSupport},
    {Technique::stacks, "slices along the volume's own axes", makeOnGl<SliceRenderer>, nullptr, stacksSupport},
    {Technique::rays, "a ray through each pixel", makeOnGl<RayCaster>, makeOnCpu<RayRenderer>, raysSupport},
    {Technique::shearWarp, "rays through the rows of the voxels' own slices", nullptr, makeOnCpu<ShearWarpRenderer>,
     shearWarpSupports},
};

template <class Runs>
const TechniqueTraits& find(const ResolvedScene& scene, const char* where, const Runs& runs) {
  if (scene.technique != Technique::automatic) {
    const TechniqueTraits& traits = traitsOf(scene.technique);
    if (!runs(traits))
      throw InvalidArgument("technique: " + techniqueName(scene.technique) + " does not run on " + where);
    return traits;
  }
  const TechniqueTraits* first = nullptr;
  for (const TechniqueTraits& traits : kTraits) {
    if (!runs(traits)) continue;
    if (traits.supports(scene)) return traits;
    if (!first) first = &traits;
  }
  return *first;  // which says in its own words what it cannot do
}

}  // namespace

std::span<const TechniqueTraits> techniques() { return kTraits; }

const TechniqueTraits& traitsOf(Technique technique) {
  return *std::ranges::find(kTraits, technique, &TechniqueTraits::technique);
}

std::unique_ptr<Renderer> makeRenderer(ResidentVolume& volume, const ResolvedScene& scene,
                                       const RenderOptions& options) {
  return find(scene, "OpenGL", [](const TechniqueTraits& traits) { return traits.makeOnGl != nullptr; })
      .makeOnGl(volume, scene, options);
}

std::unique_ptr<Renderer> makeRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options) {
  return find(scene, "the CPU", [](const TechniqueTraits& traits) { return traits.makeOnCpu != nullptr; })
      .makeOnCpu(volume, scene, options);
}

}  // namespace umbrick
