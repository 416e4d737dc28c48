// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/invariants.h"

#include <memory>

#include "check/border_check.h"
#include "check/brick_check.h"
#include "check/cut_volume.h"
#include "check/laws.h"
#include "check/mode_law.h"
#include "check/picture_laws.h"
#include "check/sampler_precision.h"
#include "check/slice_check.h"
#include "check/steps.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {
namespace {

// A full lattice is drawn only for domains of at most so many cells; more would take too long.
constexpr std::size_t kCompleteCells = 1u << 15;

// How much work a step is, where a picture of emission is 1.
constexpr double kBricksWork = 4, kSlicesWork = 1, kBorderWork = 4;

std::vector<CheckView> viewsOf(const ScalarGrid& grid, const ResolvedScene& scene, const CheckOptions& options) {
  if (!options.views.empty()) return options.views;
  std::vector<CheckView> views = checkViews(grid, scene);
  views.push_back({"the scene's camera", scene.camera, 0});
  return views;
}

class Checker {
 public:
  Checker(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& resolved, const CheckOptions& options)
      : context_(context),
        grid_(grid),
        scenes_(checkScenes(grid, resolved, options.cone)),
        options_(options),
        views_(viewsOf(grid, scenes_.emission, options)),
        volume_(cutVolume(grid, scenes_, views_, options)),
        steps_(options.progress),
        laws_(scenes_.cone.method) {}

  std::vector<InvariantResult> run() {
    const double pictures = PictureLaws::picturesOf(volume_);
    steps_.expect(static_cast<double>(volume_.bricks.size()) * kBricksWork + kBorderWork + 1 +
                  static_cast<double>(views_.size()) *
                      (static_cast<double>(volume_.bricks.size()) * kSlicesWork + ModeLaw::kWork +
                       pictures * (PictureLaws::workOf(Model::emission) + PictureLaws::workOf(Model::cone))));
    try {
      checkBricks();
      checkBorders();
      precision_ = samplerPrecision(context_, *volume_.bricks.begin()->second, scenes_.emission.bricks.format);
      checkAllSlices();
      checkPictures();
      checkModes();
    } catch (const CheckStopped&) {
      // What was measured until now is told.
    }
    return collect(std::move(laws_), referenceNote_);
  }

 private:
  void checkBricks() {
    for (const auto& [edge, bricks] : volume_.bricks) {
      steps_.begin("voxels of bricks of " + std::to_string(edge), kBricksWork);
      checkAprons(*bricks, options_.comparedBricks, options_.seed, steps_, laws_.aprons);
      checkRanges(*bricks, options_.comparedBricks, options_.seed, steps_, laws_.ranges);
    }
    finish(laws_.aprons);
    finish(laws_.ranges);
  }

  void checkBorders() {
    steps_.begin("pieces of the volume and their borders", kBorderWork);
    checkBorder(
        context_, grid_, scenes_.emission,
        [&](const ScalarGrid& piece, const BrickOptions& how) {
          return options_.cut ? options_.cut(piece, how) : brickGrid(piece, how);
        },
        steps_, laws_.border);
    finish(laws_.border);
  }

  // One renderer and its bricks stay while all views are probed.
  void checkAllSlices() {
    for (const auto& [edge, bricks] : volume_.bricks) {
      ResidentVolume resident(context_, *bricks, atlasOptions(scenes_.emission, *bricks));
      SliceChecker checker(resident, grid_, options_.probedSlices, precision_);
      const glm::dvec3 cells = glm::dvec3(bricks->domain.extent()) / static_cast<double>(edge) + 1.0;
      const bool complete = cells.x * cells.y * cells.z <= kCompleteCells;
      for (const CheckView& view : views_) {
        steps_.begin(view.name + ": slices through bricks of " + std::to_string(edge), kSlicesWork);
        const ResolvedScene scene = sceneOf(scenes_, view, Model::emission);
        const double half = complete ? 0.5 : 1;
        checker.check(scene, view.name, false, {&laws_.gaps, &laws_.doubleHits, &laws_.values},
                      [&](double share) { steps_.within(half * share); });
        if (!complete) continue;
        checker.check(scene, view.name + ", full lattice", true, {&laws_.gaps, &laws_.doubleHits, nullptr},
                      [&](double share) { steps_.within(half + half * share); });
      }
    }
    for (InvariantResult* law : {&laws_.gaps, &laws_.doubleHits, &laws_.values}) finish(*law);
  }

  void checkPictures() {
    PictureLaws pictures(context_, volume_, scenes_, precision_, steps_, options_.lightSweep);
    referenceNote_ = pictures.chooseReference(views_.front());
    for (const Model model : {Model::emission, Model::cone}) {
      for (const CheckView& view : views_) pictures.check(view, model, laws_.of(model));
      finish(laws_.of(model));
    }
  }

  void checkModes() {
    ModeLaw law(context_, volume_, steps_);
    for (const CheckView& view : views_) law.check(sceneOf(scenes_, view, Model::emission), view.name, laws_.modes);
    finish(laws_.modes);
  }

  const GlContext& context_;
  const ScalarGrid& grid_;
  const CheckScenes scenes_;
  const CheckOptions& options_;
  const std::vector<CheckView> views_;
  const CutVolume volume_;
  CheckSteps steps_;
  Laws laws_;
  double precision_ = 0;  // of the sampler, voxels
  std::string referenceNote_;
};

}  // namespace

std::vector<InvariantResult> checkInvariants(const GlContext& context, const ScalarGrid& grid,
                                             const ResolvedScene& resolved, const CheckOptions& options) {
  return Checker(context, grid, resolved, options).run();
}

}  // namespace umbrick
