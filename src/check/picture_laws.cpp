// SPDX-License-Identifier: Apache-2.0
#include "check/picture_laws.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "check/result.h"
#include "check/sampler_precision.h"
#include "core/mebibytes.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {
namespace {

RenderOptions layers(CheckSteps& steps, LightSweep lightSweep) {
  RenderOptions options;
  options.lightSweep = lightSweep;
  options.visibilityAndDepth = true;
  options.countFragments = false;
  options.progress = [&steps](double share) { steps.within(share); };
  return options;
}

}  // namespace

PictureLaws::PictureLaws(const GlContext& context, const CutVolume& volume, const CheckScenes& scenes,
                         double samplerPrecision, CheckSteps& steps, LightSweep lightSweep)
    : context_(context),
      volume_(volume),
      scenes_(scenes),
      toWorld_(volume.grid.indexToWorld()),
      precision_(samplerPrecision),
      steps_(steps),
      options_(layers(steps, lightSweep)),
      renderers_(context, scenes.emission.bricks.budgetMiB << 20, options_),
      techniques_(volume, steps) {}

PictureLaws::Drawn PictureLaws::draw(SliceRenderer& renderer) {
  steps_.begin(drawing_, work_);
  Drawn drawn;
  drawn.picture = renderer.render();
  const std::vector<double> depths = renderer.sliceDepths();
  drawn.farthest = depths.empty() ? 1 : depths.back();
  return drawn;
}

PictureLaws::Drawn PictureLaws::draw(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks) {
  return draw(renderers_.get(bricks, scene, reverseBricks));
}

std::string PictureLaws::chooseReference(const CheckView& view) {
  ResolvedScene scene = sceneOf(scenes_, view, Model::emission);
  scene.bricks.culling = false;
  drawing_ = "the volume as one texture";
  std::string why;
  for (const int edge : {0, 256, 128, 64}) {
    try {
      // Of the whole as one texture, the edge only tells how the work of finding ranges is divided.
      const int interior = edge == 0 ? std::max(volume_.sceneEdge, 8 * ((volume_.apron + 7) / 8)) : edge;
      reference_ = cutGrid(volume_.grid, bricksOf(volume_, scene, interior), edge != 0);
      // Software drivers refuse textures of more than 1 GiB.
      AtlasLimits limits;
      limits.budgetBytes = edge == 0 ? std::uint64_t{1} << 30 : 0;
      SliceRenderer trial(context_, *reference_, scene, options_, limits);
      draw(trial);
      return edge == 0 ? std::string() : "compared with bricks of " + std::to_string(edge) + ", since " + why;
    } catch (const InvalidArgument& error) {
      why = error.what();
    } catch (const GlError& error) {
      why = error.what();
    }
  }
  throw InvalidArgument("check: nothing to compare with: " + why);
}

// Returns how far rounding may move samples, voxels.
double PictureLaws::displacement(const ResolvedScene& scene, double farthest, int textureEdge) const {
  const IndexView view = indexView(scene.camera, toWorld_);
  const double scale = scene.camera.projection == Projection::perspective ? farthest : 1;
  double sideways = 0;
  for (int axis = 0; axis < 3; ++axis)
    sideways = std::max(sideways, scale * (view.halfExtent.x * std::abs(view.toIndex[0][axis]) +
                                           view.halfExtent.y * std::abs(view.toIndex[1][axis])));
  const glm::dvec3 extent(reference_->domain.extent());
  sideways = std::min(sideways, 2 * std::max({extent.x, extent.y, extent.z}));
  return coordinateError(textureEdge, sideways) + precision_;
}

PictureLaws::Reference PictureLaws::drawReference(const ResolvedScene& scene) {
  Reference reference{draw(*reference_, scene), {}};
  const double distance = displacement(scene, reference.drawn.farthest, reference.drawn.picture.stats.textureEdge);
  ResolvedScene moved = scene;
  const glm::dvec3 shift = glm::dmat3(toWorld_) * glm::dvec3(distance);
  moved.camera.eye += shift;
  moved.camera.lookAt += shift;
  const Drawn displaced = draw(*reference_, moved);
  const PictureDifference change =
      difference(reference.drawn.picture, displaced.picture, scene, reference.drawn.farthest);
  reference.perVoxel = {change.colour / distance, change.visibility / distance, change.depth / distance};
  return reference;
}

PictureLimit PictureLaws::limitFor(const Reference& reference, const ResolvedScene& scene,
                                   const Picture& picture) const {
  const int textureEdge = std::max(picture.stats.textureEdge, reference.drawn.picture.stats.textureEdge);
  const double distance = displacement(scene, reference.drawn.farthest, textureEdge);
  const PictureDifference& rate = reference.perVoxel;
  return pictureLimit({rate.colour * distance, rate.visibility * distance, rate.depth * distance}, scene,
                      reference.drawn.picture.stats.slices);
}

void PictureLaws::compare(const Drawn& a, const Drawn& b, const Reference& reference, const ResolvedScene& scene,
                          double extra, const std::string& where, InvariantResult& all,
                          InvariantResult* visibility) const {
  const PictureLimit limit = limitFor(reference, scene, a.picture);
  const PictureDifference found = difference(a.picture, b.picture, scene, reference.drawn.farthest);
  const std::size_t pixels = a.picture.visibility.pixels.size();
  const LayerShare worst = worstLayer(found, limit, extra);
  addMeasurement(all, worst.value, worst.limit, pixels, where + ": " + worst.layer);
  if (visibility)
    addMeasurement(*visibility, found.visibility, limit.rounding.visibility + limit.light + extra, pixels, where);
}

void PictureLaws::check(const CheckView& view, Model model, ModelLaws& laws) {
  drawing_ = view.name + ": " + modelName(model);
  work_ = workOf(model);
  ResolvedScene scene = sceneOf(scenes_, view, model);
  const double saturation = scene.sampling.saturation > 0 ? scene.sampling.saturation : SamplingOptions{}.saturation;
  scene.sampling.saturation = 0;
  scene.bricks.culling = false;
  const Reference reference = drawReference(scene);
  const auto placeOf = [&](int edge) { return view.name + ", bricks of " + std::to_string(edge); };

  Drawn whole;  // all of the scene's bricks
  for (const auto& [edge, bricks] : volume_.bricks) {
    Drawn drawn = draw(*bricks, scene);
    compare(drawn, reference.drawn, reference, scene, 0, placeOf(edge), laws.edges, &laws.seam);
    checkJumps(drawn, reference, scene, *bricks, placeOf(edge), laws.jumps);
    if (edge == volume_.pooledEdge) {
      checkPool(drawn, reference, scene, view.name, laws.pool);
      checkTextures(drawn, reference, scene, placeOf(edge), laws.textures);
    }
    if (edge == volume_.sceneEdge) whole = std::move(drawn);
  }
  checkCulling(whole, reference, scene, saturation, placeOf(volume_.sceneEdge), laws);
  checkTechniques(scene, view.name, laws.techniques);
}

void PictureLaws::checkTechniques(ResolvedScene scene, const std::string& view, InvariantResult& result) {
  scene.bricks.culling = true;
  const Bricks& bricks = *volume_.bricks.at(volume_.sceneEdge);
  const std::shared_ptr<ResidentVolume> resident = renderers_.volume(bricks, scene);
  techniques_.check(renderers_.get(bricks, scene), *resident, view + ", " + modelName(scene.model), work_, result);
}

void PictureLaws::checkCulling(const Drawn& whole, const Reference& reference, ResolvedScene scene, double saturation,
                               const std::string& where, ModelLaws& laws) {
  const Bricks& bricks = *volume_.bricks.at(volume_.sceneEdge);
  scene.bricks.culling = true;
  compare(draw(bricks, scene), whole, reference, scene, 0, where, laws.culling, &laws.skipped);

  // A saturated pixel lets through less than `saturation`; what dos leaves out at each look is below 1e-5.
  const double looks = 1 + static_cast<double>(whole.picture.stats.slices) / 24;
  const double extra = saturation + (occlusionMethod(scene) == Method::dos ? 1e-5 * looks : 0);
  scene.sampling.saturation = saturation;
  const Drawn culled = draw(bricks, scene);
  scene.bricks.culling = false;
  compare(culled, draw(bricks, scene), reference, scene, extra, where, laws.saturated, nullptr);
  scene.bricks.culling = true;
  const PictureDifference order =
      difference(culled.picture, draw(bricks, scene, /*reverseBricks=*/true).picture, scene, reference.drawn.farthest);
  addMeasurement(laws.order, std::max({order.colour, order.visibility, order.depth}), 0,
                 culled.picture.visibility.pixels.size(), where);
}

// Draws with a pool that must recycle its slots.
void PictureLaws::checkPool(const Drawn& whole, const Reference& reference, const ResolvedScene& scene,
                            const std::string& view, InvariantResult& result) {
  const Bricks& bricks = *volume_.bricks.at(volume_.pooledEdge);
  const RenderStats& stats = whole.picture.stats;
  // A few trials find the smallest pool that holds what one slice needs. The cone begins with that of emission.
  for (double& share = poolShare_.try_emplace(view, 1.0 / 8).first->second; share < 1; share *= 1.7) {
    AtlasLimits limits;
    limits.budgetBytes = static_cast<std::uint64_t>(share * static_cast<double>(stats.textureBytes));
    try {
      const Drawn drawn = draw(renderers_.get(bricks, scene, limits));
      compare(drawn, reference.drawn, reference, scene, 0,
              view + ", bricks of " + std::to_string(volume_.pooledEdge) + ", " + mebibytes(limits.budgetBytes) +
                  " of " + mebibytes(stats.textureBytes) + ", " + std::to_string(drawn.picture.stats.uploadedBricks) +
                  " uploads of " + std::to_string(stats.brickSlots) + " bricks",
              result, nullptr);
      return;
    } catch (const InvalidArgument&) {
      renderers_.forget(bricks, limits);  // this pool is too small for one slice
    }
  }
}

// Draws with bricks spread over several textures.
void PictureLaws::checkTextures(const Drawn& whole, const Reference& reference, const ResolvedScene& scene,
                                const std::string& where, InvariantResult& result) {
  const Bricks& bricks = *volume_.bricks.at(volume_.pooledEdge);
  const RenderStats& stats = whole.picture.stats;
  if (stats.brickSlots < 4) return;
  AtlasLimits bytes, edge;
  bytes.maxTextureBytes = stats.textureBytes / 3;
  // The limit is half as many bricks along an edge as one texture of all bricks would have.
  const int along = static_cast<int>(std::cbrt(static_cast<double>(stats.brickSlots)) / 2);
  edge.maxTextureEdge = bricks.layout.edge().x * std::max(1, along);
  for (const AtlasLimits& limits : {bytes, edge}) {
    const Drawn drawn = draw(renderers_.get(bricks, scene, limits));
    compare(drawn, reference.drawn, reference, scene, 0,
            where + ", " + std::to_string(drawn.picture.stats.textures) + " textures", result, nullptr);
  }
}

void PictureLaws::checkJumps(const Drawn& drawn, const Reference& reference, const ResolvedScene& scene,
                             const Bricks& bricks, const std::string& where, InvariantResult& result) const {
  // Faces of x and z are seen as lines only by a parallel view along y.
  if (scene.camera.projection != Projection::orthographic) return;
  const IndexView view = indexView(scene.camera, toWorld_);
  const glm::dvec3 forward = glm::abs(view.toIndex[2]);
  if (std::max(forward.x, forward.z) > 1e-9 * forward.y) return;
  std::size_t pairs = 0;
  const double excess = seamExcess(drawn.picture, reference.drawn.picture, scene, bricks, pairs);
  const PictureLimit limit = limitFor(reference, scene, drawn.picture);
  // Both ends of a step may be wrong.
  if (pairs > 0) addMeasurement(result, excess, 2 * (limit.rounding.visibility + limit.light), pairs, where);
}

}  // namespace umbrick
