// SPDX-License-Identifier: Apache-2.0
#include "check/technique_law.h"

#include "check/picture_difference.h"
#include "umbrick/core/error.h"
#include "umbrick/draw/progressive.h"
#include "umbrick/render/techniques.h"
#include "umbrick/sweep/swept_bricks.h"

namespace umbrick {
namespace {

// Samples go through the centres of pixels, and have the same directions in all techniques.
ProgressivePicture drawn(Renderer& renderer) {
  return renderProgressive(renderer, {.passes = kStreams, .pixelArea = false});
}

// Returns how far apart pictures may be by the rounding of sums: of slabs on OpenGL, of the table on the CPU.
double rounding(const RenderStats& slices) { return static_cast<double>(slices.slices) * 0x1p-23 + 0x1p-18; }

}  // namespace

Renderer& TechniqueLaw::rendererOf(Technique technique, const ResolvedScene& scene) {
  if (!bricks_) {
    BrickOptions options = sweptBricks(scene);
    options.interior = volume_.sceneEdge;
    bricks_ = cutGrid(volume_.grid, options, true);
  }
  std::unique_ptr<Renderer>& renderer = renderers_[technique];
  if (renderer)
    renderer->setScene(scene);
  else
    renderer = traitsOf(technique).makeOnCpu(*bricks_, scene, {});
  return *renderer;
}

void TechniqueLaw::compare(Renderer& slices, std::optional<ProgressivePicture>& bySlices, Renderer& other,
                           const std::string& where, InvariantResult& result) const {
  if (!bySlices) bySlices = drawn(slices);
  const ProgressivePicture picture = drawn(other);
  const double said = bySlices->error.total() + picture.error.total();
  addMeasurement(result, rmsOfColour(bySlices->picture.colour, picture.picture.colour),
                 2 * said + rounding(bySlices->picture.stats), bySlices->picture.colour.pixels.size() / 4, where);
}

void TechniqueLaw::check(Renderer& slices, ResidentVolume& resident, const std::string& where, double work,
                         InvariantResult& result) {
  const ResolvedScene scene = slices.scene();
  std::optional<ProgressivePicture> bySlices;
  for (const TechniqueTraits& traits : techniques()) {
    if (traits.technique == Technique::slices || !traits.supports(scene)) continue;
    const std::string name = techniqueName(traits.technique);
    ResolvedScene there = scene;
    there.technique = traits.technique;
    if (traits.makeOnGl) {
      steps_.begin(where + ": " + name + " on OpenGL", kWork * work / 3);
      compare(slices, bySlices, *traits.makeOnGl(resident, there, {}), where + ": slices and " + name + " on OpenGL",
              result);
    }
    if (traits.makeOnCpu) {
      steps_.begin(where + ": " + name, kWork * work / 3);
      compare(slices, bySlices, rendererOf(traits.technique, there), where + ": slices and " + name, result);
    }
  }
}

}  // namespace umbrick
