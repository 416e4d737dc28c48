// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/case_scene.h"
#include "umbrick/scene/capabilities.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
namespace {

void setSize(Camera& camera, int height) {
  const double aspect = static_cast<double>(camera.width) / camera.height;
  camera.width = std::max(1, static_cast<int>(std::lround(height * aspect)));
  camera.height = height;
}

}  // namespace

ResolvedScene studyScene(const ResolvedScene& resolved, const StudyPlan& plan, double voxelEdge) {
  ResolvedScene scene = resolved;
  scene.background.reset();
  scene.model = Model::emission;
  scene.method = Method::dos;
  scene.technique = Technique::slices;
  showAs(StudyLook::medium, scene);
  scene.sampling.classification = Classification::post;
  scene.sampling.spacing = SamplingOptions{}.spacing * voxelEdge;
  scene.sampling.segments = plan.settings.segments.front();
  scene.sampling.bits = plan.baseBits.eye;
  const bool perspectiveCorrection = scene.occlusion.dos.perspectiveCorrection;
  scene.occlusion = OcclusionOptions{};
  scene.occlusion.dos.perspectiveCorrection = perspectiveCorrection;
  setSize(scene.camera, plan.baseSize);
  return scene;
}

ResolvedScene caseScene(const ResolvedScene& scene, const StudyCase& what, const StudyGeometry& geometry) {
  const StudyMethod& method = studyMethod(what.method);
  ResolvedScene result = scene;
  setSize(result.camera, what.size);
  result.model = method.model;
  result.sampling.spacing = geometry.extent / what.slices;
  result.sampling.segments =
      what.segments == kAutomaticSegments ? segmentsOf(result.sampling.spacing / geometry.voxelEdge) : what.segments;
  result.sampling.bits = what.bits.eye;
  if (traitsOf(method.model).occlusion) {
    result.occlusion.bits = what.bits.occlusion;
    result.occlusion.aperture = what.theta;
    result.occlusion.ordinates.scale = what.scale;
  }
  showAs(method.look, result);
  method.apply(what.detail, result);
  return result;
}

ResolvedScene referenceScene(const ResolvedScene& scene, const StudyReference& what) {
  ResolvedScene result = scene;
  setSize(result.camera, what.size);
  result.model = what.model;
  showAs(what.look, result);
  if (traitsOf(what.model).cone) result.occlusion.aperture = what.theta;
  return result;
}

ResolvedScene baselineScene(const ResolvedScene& scene, int size, const StudyGeometry& geometry) {
  StudyCase baseline;
  baseline.method = "emission";
  baseline.slices = kBaselineSlices;
  baseline.size = size;
  return caseScene(scene, baseline, geometry);
}

ReferenceOptions referenceOptions(const StudySettings& settings, bool coarser) {
  ReferenceOptions options;
  options.directions = coarser ? settings.directions / 2 : settings.directions;
  options.tolerance = coarser ? std::min(1.0, 4 * settings.tolerance) : settings.tolerance;
  return options;
}

}  // namespace umbrick
