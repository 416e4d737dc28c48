// SPDX-License-Identifier: Apache-2.0
#include "check/laws.h"

#include <utility>

#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

InvariantResult makeResult(int invariant, std::string name, std::string measured, std::string limitFrom) {
  InvariantResult result;
  result.invariant = invariant;
  result.name = std::move(name);
  result.measured = std::move(measured);
  result.limitFrom = std::move(limitFrom);
  result.complete = false;
  return result;
}

}  // namespace

ModelLaws::ModelLaws(Model model, Method method) {
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
  techniques = makeResult(8, "other techniques agree with slices" + m, "RMS difference of colour",
                          "twice the errors that both say they have");
}

Laws::Laws(Method method)
    : aprons(makeResult(3, "aprons equal the neighbours' voxels", "voxels that differ", "copies: none")),
      ranges(makeResult(4, "ranges hold all voxels of a brick", "voxels outside their brick's range", "exact: none")),
      gaps(makeResult(2, "every pixel of a slice is shaded", "pixels inside bricks that none shades",
                      "vertices are shared to the bit: none")),
      doubleHits(makeResult(2, "no pixel of a slice is shaded twice",
                            "pixels shaded by more than the brick they lie in", "as above: none")),
      values(makeResult(3, "interpolated values equal BoxSampler's",
                        "displacement of samples that explains the difference, voxels",
                        "rounding of texture coordinates, precision of the sampler")),
      border(makeResult(7, "the border of pieces of the volume is whole",
                        "largest difference of colour from the piece with room around it",
                        "rounding of texture coordinates and sums")),
      modes(makeResult(8, "rays on OpenGL and on the CPU agree in other modes",
                       "RMS difference of values, as shares of their range, or of colours",
                       "twice the change by half the spacing, rounding of places")),
      emission(Model::emission, method),
      cone(Model::cone, method) {}

void finish(ModelLaws& laws) {
  for (InvariantResult* law : {&laws.edges, &laws.pool, &laws.textures, &laws.culling, &laws.saturated, &laws.seam,
                               &laws.skipped, &laws.jumps, &laws.order, &laws.techniques})
    finish(*law);
}

std::vector<InvariantResult> collect(Laws laws, const std::string& referenceNote) {
  std::vector<InvariantResult> results;
  const auto add = [&](InvariantResult& result, const std::string& ifNone) {
    if (result.samples == 0) {
      result.passed = result.complete;
      result.detail = result.complete ? ifNone : "not tried: the check was stopped before";
    }
    if (result.invariant == 1 && !referenceNote.empty()) result.detail += "; " + referenceNote;
    results.push_back(std::move(result));
  };
  const std::string fewBricks = "not measured: too few bricks";
  for (ModelLaws* model : {&laws.emission, &laws.cone}) {
    add(model->edges, "");
    add(model->pool, fewBricks);
    add(model->textures, fewBricks);
  }
  add(laws.gaps, "");
  add(laws.doubleHits, "");
  add(laws.aprons, "");
  add(laws.values, "not measured: no pixel is hit");
  add(laws.ranges, "");
  for (ModelLaws* model : {&laws.emission, &laws.cone}) {
    add(model->culling, "");
    add(model->saturated, "");
  }
  add(laws.cone.seam, "");
  add(laws.cone.skipped, "");
  add(laws.cone.jumps, "not measured: no parallel view along the faces");
  for (ModelLaws* model : {&laws.emission, &laws.cone}) add(model->order, "");
  add(laws.border, "not measured: the background is visible, or no leaf of the grid");
  for (ModelLaws* model : {&laws.emission, &laws.cone})
    add(model->techniques, "not measured: no other technique has this method");
  add(laws.modes, "");
  return results;
}

}  // namespace umbrick
