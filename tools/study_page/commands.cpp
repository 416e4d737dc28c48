// SPDX-License-Identifier: Apache-2.0
#include "study_page/commands.h"

#include "core/json_writer.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick::tools {
namespace {

std::string sizeOption(const ResolvedScene& scene) {
  return " --size " + std::to_string(scene.camera.width) + "x" + std::to_string(scene.camera.height);
}

// Returns what makes a scene of the medium one of a look.
std::string lookOptions(StudyLook look) {
  if (look == StudyLook::medium) return {};
  return look == StudyLook::phong ? " --shading phong" : " --mode " + lookName(look);
}

// Returns what a method sets in the scene of the study, as options.
std::string methodOptions(const StudyMethod& method, const ResolvedScene& scene, const ResolvedScene& ofCase) {
  std::string text = lookOptions(method.look);
  if (ofCase.technique != scene.technique)
    text += " --technique " + techniqueName(ofCase.technique) + " --backend " + (method.onCpu ? "cpu" : "osmesa");
  if (scene.bricks.bricked && !ofCase.bricks.bricked) text += " --unbricked";
  if (scene.bricks.culling && !ofCase.bricks.culling) text += " --no-culling";
  if (ofCase.sampling.quadrature != scene.sampling.quadrature)
    text += " --quadrature " + std::string(nameOf(kQuadratures, ofCase.sampling.quadrature));
  if (ofCase.sampling.classification != scene.sampling.classification)
    text += " --classification " + std::string(nameOf(kClassifications, ofCase.sampling.classification));
  if (ofCase.sampling.saturation != scene.sampling.saturation)
    text += " --saturation " + jsonNumber(ofCase.sampling.saturation);
  if (!traitsOf(ofCase.model).occlusion) return text;
  text += " --method " + methodName(ofCase.method);
  const OcclusionOptions& occlusion = ofCase.occlusion;
  if (traitsOf(ofCase.method).directions)
    return text + " --directions " + std::to_string(occlusion.ordinates.directions);
  return text + " --algorithm " + std::to_string(occlusion.dos.algorithm) + " --passes " +
         std::to_string(occlusion.dos.passes) + " --footprint " + std::to_string(occlusion.dos.footprint);
}

}  // namespace

std::string renderCommand(const StudyCase& what, const ResolvedScene& scene, const StudyGeometry& geometry) {
  const StudyMethod& method = studyMethod(what.method);
  const ResolvedScene result = caseScene(scene, what, geometry);
  std::string text = "umbrick render scene.json --model " + modelName(method.model);
  text += methodOptions(method, scene, result);
  if (traitsOf(method.model).occlusion)
    text += " --theta " + jsonDegrees(what.theta) + " --occlusion-bits " + std::to_string(what.bits.occlusion);
  if (what.scale > 0) text += " --occlusion-scale " + jsonNumber(what.scale);
  if (result.technique == scene.technique) text += " --eye-bits " + std::to_string(what.bits.eye);
  text += " --spacing " + jsonNumber(result.sampling.spacing) + " --spacing-unit world --segments " +
          std::to_string(result.sampling.segments) + sizeOption(result) + " --exr-pixel float -o " + what.id() + ".exr";
  return text;
}

std::string referenceCommand(const StudyReference& what, const ResolvedScene& scene, const StudySettings& settings) {
  std::string text = "umbrick reference scene.json --model " + modelName(what.model);
  text += lookOptions(what.look);
  if (traitsOf(what.model).cone) text += " --theta " + jsonDegrees(what.theta);
  return text + " --directions " + std::to_string(settings.directions) + " --tolerance " +
         jsonNumber(settings.tolerance) + sizeOption(referenceScene(scene, what)) + " -o references/" + what.id() +
         ".exr";
}

std::string compareCommand(const StudyCase& what, const StudyReference& reference) {
  return "umbrick compare " + what.id() + ".exr references/" + reference.id() + ".exr";
}

}  // namespace umbrick::tools
