// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/invariants.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "check/border_check.h"
#include "check/brick_check.h"
#include "check/picture_check.h"
#include "check/result.h"
#include "check/sampler_precision.h"
#include "check/slice_check.h"
#include "core/mebibytes.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {
namespace {

// A full lattice is drawn only for domains of at most so many cells; more would take too long.
constexpr std::size_t kCompleteCells = 1u << 15;

InvariantResult makeResult(int invariant, std::string name, std::string measured, std::string limitFrom) {
  InvariantResult result;
  result.invariant = invariant;
  result.name = std::move(name);
  result.measured = std::move(measured);
  result.limitFrom = std::move(limitFrom);
  return result;
}

// The results of one model.
struct ModelResults {
  InvariantResult edges, pool, textures, culling, saturated, seam, skipped, jumps, order;

  ModelResults(Model model, Method method) {
    const std::string m = ", " + modelName(model);
    const std::string picture = "largest difference of colour, V and depth";
    const std::string rounding = "rounding of texture coordinates and sums";
    const std::string light = traitsOf(model).occlusion && method == Method::dos ? ", light beyond 4 deviations" : "";
    edges = makeResult(1, "bricked equals unbricked" + m, picture, rounding + light);
    pool = makeResult(1, "a pool smaller than the volume" + m, picture, rounding + light);
    textures = makeResult(1, "several textures" + m, picture, rounding + light);
    culling = makeResult(4, "culled equals not culled" + m, picture, rounding + light);
    saturated = makeResult(4, "culled equals not culled, saturated pixels rejected" + m, picture,
                           "saturation, " + rounding + light);
    seam = makeResult(5, "V across bricks" + m, "largest difference of V from unbricked", rounding + light);
    skipped = makeResult(5, "V across skipped space" + m, "largest difference of V from not culled", rounding + light);
    jumps = makeResult(5, "V beside projected brick faces" + m, "how much steeper than unbricked", rounding + light);
    order = makeResult(6, "bricks drawn in reverse" + m, picture, "the same samples: none");
  }
};

class Checker {
 public:
  Checker(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene, const CheckOptions& options)
      : context_(context),
        grid_(grid),
        scene_(scene),
        options_(options),
        toWorld_(grid.indexToWorld()),
        resident_(context, scene.bricks.budgetMiB << 20),
        emission_(Model::emission, scene.method),
        cone_(Model::cone, scene.method) {
    scene_.background.reset();  // the same light must be behind both pictures
    scene_.bricks.interior = brickInterior(scene_, toWorld_, grid.worldBounds());
    views_ = options.views;
    if (views_.empty()) {
      views_ = checkViews(grid, scene_);
      views_.push_back({"the scene's camera", scene_.camera, 0});
    }
  }

  std::vector<InvariantResult> run() {
    cutAll();
    // The steps are views x (edges in slices, two models of about 13 pictures), and the bricks themselves.
    steps_ = static_cast<double>(bricks_.size() + 2 + views_.size() * (bricks_.size() + 28));
    checkBricks();
    precision_ = samplerPrecision(context_, *bricks_.begin()->second, scene_.bricks.format);
    chooseReference();
    for (const CheckView& view : views_) checkSlicesOf(view);
    for (const CheckView& view : views_)
      for (const Model model : {Model::emission, Model::cone}) checkPicturesOf(view, model);
    step("pieces of the volume and their borders");
    checkBorder(
        context_, grid_, scene_,
        [&](const ScalarGrid& piece, const BrickOptions& how) {
          return options_.cut ? options_.cut(piece, how) : brickGrid(piece, how);
        },
        border_);
    return collect();
  }

 private:
  ResolvedScene sceneOf(const CheckView& view, Model model) const {
    ResolvedScene scene = scene_;
    scene.camera = view.camera;
    if (view.spacing > 0) scene.sampling.spacing = view.spacing;
    scene.model = model;
    return scene;
  }

  void step(const std::string& what) {
    if (options_.progress) options_.progress(what, std::min(1.0, done_ / steps_));
    done_ += 1;
  }

  std::unique_ptr<Bricks> cut(int edge) const {
    BrickOptions options;
    options.interior = edge;
    options.apron = apron_;
    options.gradients = scene_.transfer.is2d();
    return options_.cut ? options_.cut(grid_, options) : brickGrid(grid_, options);
  }

  // Cuts the volume once per edge, with one apron that is wide enough for all views.
  void cutAll() {
    for (const CheckView& view : views_) {
      ResolvedScene scene = sceneOf(view, Model::emission);
      scene.bricks.interior = 256;
      apron_ = std::max(apron_, requiredApron(scene, toWorld_));
    }
    std::vector<int> edges = options_.edges;
    edges.push_back(scene_.bricks.interior);
    for (const int edge : edges)
      if (edge >= apron_ && !bricks_.contains(edge)) bricks_[edge] = cut(edge);
    if (bricks_.empty())
      throw InvalidArgument("check: slabs need an apron of " + std::to_string(apron_) +
                            " voxels, wider than every brick");
    if (bricks_.begin()->second->bricks.empty())
      throw InvalidArgument("check: the volume holds nothing but background");
    sceneEdge_ = bricks_.contains(scene_.bricks.interior) ? scene_.bricks.interior : bricks_.rbegin()->first;
    // A pool and several textures make a difference only where there are some bricks.
    pooledEdge_ = bricks_.at(sceneEdge_)->bricks.size() >= 27 ? sceneEdge_ : bricks_.begin()->first;
  }

  void checkBricks() {
    for (const auto& [edge, bricks] : bricks_) {
      step("voxels of bricks of " + std::to_string(edge));
      checkAprons(*bricks, options_.comparedBricks, options_.seed, aprons_);
      checkRanges(*bricks, options_.comparedBricks, options_.seed, ranges_);
    }
  }

  void checkSlicesOf(const CheckView& view) {
    const ResolvedScene scene = sceneOf(view, Model::emission);
    SliceCheckOptions options;
    options.slices = options_.probedSlices;
    options.samplerPrecision = precision_;
    for (const auto& [edge, bricks] : bricks_) {
      step(view.name + ": slices through bricks of " + std::to_string(edge));
      options.complete = false;
      const auto resident = resident_.get(*bricks, atlasOptions(scene, *bricks));
      checkSlices(*resident, grid_, scene, view.name, options, {&gaps_, &doubleHits_, &values_});
      const glm::dvec3 cells = glm::dvec3(bricks->domain.extent()) / static_cast<double>(edge) + 1.0;
      if (cells.x * cells.y * cells.z > kCompleteCells) continue;
      options.complete = true;
      checkSlices(*resident, grid_, scene, view.name + ", full lattice", options, {&gaps_, &doubleHits_, nullptr});
    }
  }

  struct Drawn {
    Picture picture;
    double farthest = 0;
  };

  static RenderOptions layers() {
    RenderOptions options;
    options.visibilityAndDepth = true;
    options.countFragments = false;
    return options;
  }

  // Draws from bricks that stay resident from one picture to the next.
  Drawn draw(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks = false) {
    step(drawing_);
    RenderOptions options = layers();
    options.reverseBricks = reverseBricks;
    const auto resident = resident_.get(bricks, atlasOptions(scene, bricks));
    SliceRenderer renderer(*resident, scene, options);
    return drawnBy(renderer);
  }

  // Draws from an atlas of its own, with other limits.
  Drawn draw(const Bricks& bricks, const ResolvedScene& scene, const AtlasLimits& limits) {
    step(drawing_);
    SliceRenderer renderer(context_, bricks, scene, layers(), limits);
    return drawnBy(renderer);
  }

  static Drawn drawnBy(SliceRenderer& renderer) {
    Drawn drawn;
    drawn.picture = renderer.render();
    const std::vector<double> depths = renderer.sliceDepths();
    drawn.farthest = depths.empty() ? 1 : depths.back();
    return drawn;
  }

  // Chooses the whole volume as one texture or, when that is too large, the largest bricks of which one fits.
  void chooseReference() {
    ResolvedScene scene = sceneOf(views_.front(), Model::emission);
    scene.bricks.culling = false;
    BrickOptions options;
    options.interior = sceneEdge_;
    options.apron = apron_;
    options.gradients = scene_.transfer.is2d();
    std::string why;
    for (const int edge : {0, 256, 128, 64}) {
      try {
        options.interior = edge == 0 ? std::max(sceneEdge_, 8 * ((apron_ + 7) / 8)) : edge;
        reference_ = edge == 0 ? unbrickedGrid(grid_, options) : brickGrid(grid_, options);
        drawing_ = "the volume as one texture";
        // Software drivers refuse textures of more than 1 GiB.
        AtlasLimits limits;
        limits.budgetBytes = edge == 0 ? std::uint64_t{1} << 30 : 0;
        draw(*reference_, scene, limits);
        if (edge > 0) referenceNote_ = "compared with bricks of " + std::to_string(edge) + ", since " + why;
        return;
      } catch (const InvalidArgument& error) {
        why = error.what();
      } catch (const GlError& error) {
        why = error.what();
      }
    }
    throw InvalidArgument("check: nothing to compare with: " + why);
  }

  // Returns how far rounding may move samples, voxels.
  double displacement(const ResolvedScene& scene, double farthest, int textureEdge) const {
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

  // A picture without bricks, and how much it changes when all samples move a little.
  struct Reference {
    Drawn drawn;
    PictureDifference perVoxel;  // for a displacement along each axis
  };

  Reference drawReference(const ResolvedScene& scene) {
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

  PictureLimit limitFor(const Reference& reference, const ResolvedScene& scene, const Picture& picture) const {
    const int textureEdge = std::max(picture.stats.textureEdge, reference.drawn.picture.stats.textureEdge);
    const double distance = displacement(scene, reference.drawn.farthest, textureEdge);
    const PictureDifference& rate = reference.perVoxel;
    return pictureLimit({rate.colour * distance, rate.visibility * distance, rate.depth * distance}, scene,
                        reference.drawn.picture.stats.slices);
  }

  void compare(const Drawn& a, const Drawn& b, const Reference& reference, const ResolvedScene& scene, double extra,
               const std::string& where, InvariantResult& all, InvariantResult* visibility) const {
    const PictureLimit limit = limitFor(reference, scene, a.picture);
    const PictureDifference found = difference(a.picture, b.picture, scene, reference.drawn.farthest);
    const std::size_t pixels = a.picture.visibility.pixels.size();
    const LayerShare worst = worstLayer(found, limit, extra);
    addMeasurement(all, worst.value, worst.limit, pixels, where + ": " + worst.layer);
    if (visibility)
      addMeasurement(*visibility, found.visibility, limit.rounding.visibility + limit.light + extra, pixels, where);
  }

  void checkPicturesOf(const CheckView& view, Model model) {
    drawing_ = view.name + ": " + modelName(model);
    ResolvedScene scene = sceneOf(view, model);
    ModelResults& results = model == Model::cone ? cone_ : emission_;
    const double saturation = scene.sampling.saturation > 0 ? scene.sampling.saturation : SamplingOptions{}.saturation;
    scene.sampling.saturation = 0;
    scene.bricks.culling = false;
    const Reference reference = drawReference(scene);

    Drawn whole;  // all of the scene's bricks
    for (const auto& [edge, bricks] : bricks_) {
      Drawn drawn = draw(*bricks, scene);
      const std::string where = view.name + ", bricks of " + std::to_string(edge);
      compare(drawn, reference.drawn, reference, scene, 0, where, results.edges, &results.seam);
      checkJumps(drawn, reference, scene, *bricks, where, results.jumps);
      if (edge == pooledEdge_) checkAtlas(drawn, reference, scene, view, results);
      if (edge == sceneEdge_) whole = std::move(drawn);
    }

    const Bricks& bricks = *bricks_.at(sceneEdge_);
    const std::string where = view.name + ", bricks of " + std::to_string(sceneEdge_);
    scene.bricks.culling = true;
    compare(draw(bricks, scene), whole, reference, scene, 0, where, results.culling, &results.skipped);

    // A saturated pixel lets through less than `saturation`; what dos leaves out at each look is below 1e-5.
    const double looks = 1 + static_cast<double>(whole.picture.stats.slices) / 24;
    const double extra = saturation + (occlusionMethod(scene) == Method::dos ? 1e-5 * looks : 0);
    scene.sampling.saturation = saturation;
    const Drawn culled = draw(bricks, scene);
    scene.bricks.culling = false;
    compare(culled, draw(bricks, scene), reference, scene, extra, where, results.saturated, nullptr);
    scene.bricks.culling = true;
    const PictureDifference order = difference(culled.picture, draw(bricks, scene, /*reverseBricks=*/true).picture,
                                               scene, reference.drawn.farthest);
    addMeasurement(results.order, std::max({order.colour, order.visibility, order.depth}), 0,
                   culled.picture.visibility.pixels.size(), where);
  }

  // Draws with a pool that must recycle its slots, and with bricks spread over several textures.
  void checkAtlas(const Drawn& whole, const Reference& reference, const ResolvedScene& scene, const CheckView& view,
                  ModelResults& results) {
    const Bricks& bricks = *bricks_.at(pooledEdge_);
    const RenderStats& stats = whole.picture.stats;
    const std::string where = view.name + ", bricks of " + std::to_string(pooledEdge_);
    // A few trials find the smallest pool that holds what one slice needs.
    for (double share = 1.0 / 8; share < 1; share *= 1.7) {
      AtlasLimits options;
      options.budgetBytes = static_cast<std::uint64_t>(share * static_cast<double>(stats.textureBytes));
      try {
        const Drawn drawn = draw(bricks, scene, options);
        compare(drawn, reference.drawn, reference, scene, 0,
                where + ", " + mebibytes(options.budgetBytes) + " of " + mebibytes(stats.textureBytes) + ", " +
                    std::to_string(drawn.picture.stats.uploadedBricks) + " uploads of " +
                    std::to_string(stats.brickSlots) + " bricks",
                results.pool, nullptr);
        break;
      } catch (const InvalidArgument&) {
        // This pool is too small for one slice.
      }
    }
    if (stats.brickSlots < 4) return;
    const auto compareTextures = [&](const AtlasLimits& options) {
      const Drawn drawn = draw(bricks, scene, options);
      compare(drawn, reference.drawn, reference, scene, 0,
              where + ", " + std::to_string(drawn.picture.stats.textures) + " textures", results.textures, nullptr);
    };
    AtlasLimits bytes, edge;
    bytes.maxTextureBytes = stats.textureBytes / 3;
    compareTextures(bytes);
    // The limit is half as many bricks along an edge as one texture of all bricks would have.
    const int brickEdge = bricks.layout.edge().x;
    const int along = static_cast<int>(std::cbrt(static_cast<double>(stats.brickSlots)) / 2);
    edge.maxTextureEdge = brickEdge * std::max(1, along);
    compareTextures(edge);
  }

  void checkJumps(const Drawn& drawn, const Reference& reference, const ResolvedScene& scene, const Bricks& bricks,
                  const std::string& where, InvariantResult& result) const {
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

  std::vector<InvariantResult> collect() {
    std::vector<InvariantResult> results;
    const auto add = [&](InvariantResult& result, const std::string& ifNone) {
      if (result.samples == 0) {
        result.passed = true;
        result.detail = ifNone;
      }
      if (result.invariant == 1 && !referenceNote_.empty()) result.detail += "; " + referenceNote_;
      results.push_back(std::move(result));
    };
    const std::string fewBricks = "not measured: too few bricks";
    for (ModelResults* model : {&emission_, &cone_}) {
      add(model->edges, "");
      add(model->pool, fewBricks);
      add(model->textures, fewBricks);
    }
    add(gaps_, "");
    add(doubleHits_, "");
    add(aprons_, "");
    add(values_, "not measured: no pixel is hit");
    add(ranges_, "");
    for (ModelResults* model : {&emission_, &cone_}) {
      add(model->culling, "");
      add(model->saturated, "");
    }
    add(cone_.seam, "");
    add(cone_.skipped, "");
    add(cone_.jumps, "not measured: no parallel view along the faces");
    for (ModelResults* model : {&emission_, &cone_}) add(model->order, "");
    add(border_, "not measured: the background is visible, or no leaf of the grid");
    return results;
  }

  const GlContext& context_;
  const ScalarGrid& grid_;
  ResolvedScene scene_;
  const CheckOptions& options_;
  const glm::dmat4 toWorld_;
  std::vector<CheckView> views_;
  std::map<int, std::unique_ptr<Bricks>> bricks_;  // by edge
  std::unique_ptr<Bricks> reference_;
  ResidentVolumes resident_;
  std::string referenceNote_;
  int apron_ = 1, sceneEdge_ = 0, pooledEdge_ = 0;
  double precision_ = 0;  // of the sampler, voxels
  double done_ = 0, steps_ = 1;
  std::string drawing_;

  ModelResults emission_, cone_;
  InvariantResult gaps_ = makeResult(2, "every pixel of a slice is shaded", "pixels inside bricks that none shades",
                                     "vertices are shared to the bit: none");
  InvariantResult doubleHits_ = makeResult(2, "no pixel of a slice is shaded twice",
                                           "pixels shaded by more than the brick they lie in", "as above: none");
  InvariantResult aprons_ = makeResult(3, "aprons equal the neighbours' voxels", "voxels that differ", "copies: none");
  InvariantResult values_ = makeResult(3, "interpolated values equal BoxSampler's",
                                       "displacement of samples that explains the difference, voxels",
                                       "rounding of texture coordinates, precision of the sampler");
  InvariantResult border_ = makeResult(7, "the border of pieces of the volume is whole",
                                       "largest difference of colour from the piece with room around it",
                                       "rounding of texture coordinates and sums");
  InvariantResult ranges_ =
      makeResult(4, "ranges hold all voxels of a brick", "voxels outside their brick's range", "exact: none");
};

}  // namespace

std::vector<InvariantResult> checkInvariants(const GlContext& context, const ScalarGrid& grid,
                                             const ResolvedScene& resolved, const CheckOptions& options) {
  return Checker(context, grid, resolved, options).run();
}

}  // namespace umbrick
