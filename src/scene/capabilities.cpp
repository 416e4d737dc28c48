// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/capabilities.h"

#include <algorithm>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr ModelTraits kModelTraits[]{
    {.model = Model::emission, .meaning = "no occlusion"},
    {.model = Model::cone, .meaning = "around the slice normal", .occlusion = true, .cone = true, .directions = true},
    {.model = Model::coneRay,
     .meaning = "around the view ray",
     .occlusion = true,
     .cone = true,
     .aroundRay = true,
     .behindEye = true},
    {.model = Model::ambient,
     .meaning = "whole sphere",
     .occlusion = true,
     .sphere = true,
     .directions = true,
     .behindEye = true},
    {.model = Model::lights,
     .meaning = "the scene's light.sources",
     .occlusion = true,
     .directions = true,
     .sources = true},
};

constexpr MethodTraits kMethodTraits[]{
    {.method = Method::dos, .meaning = "one occlusion buffer that is blurred from slice to slice"},
    {.method = Method::ordinates,
     .meaning = "a transmittance for each of a set of directions",
     .sources = true,
     .directions = true},
    {.method = Method::lightVolume,
     .meaning = "light at every voxel, computed before the picture is drawn",
     .sources = true,
     .directions = true,
     .allAround = true},
    {.method = Method::coneRays,
     .meaning = "rays towards the light from each sample, slow, to compare the others with",
     .sources = true,
     .directions = true,
     .allAround = true},
};

constexpr ModeTraits kModeTraits[]{
    {.mode = Mode::integrate, .meaning = "a medium that scatters and absorbs", .medium = true},
    {.mode = Mode::mip, .meaning = "the largest value along each ray", .projection = true, .ofValues = true},
    {.mode = Mode::minip, .meaning = "the smallest one", .projection = true, .ofValues = true},
    {.mode = Mode::average, .meaning = "the mean", .projection = true, .ofValues = true},
    {.mode = Mode::xray, .meaning = "the share of light that gets through", .projection = true, .medium = true},
    {.mode = Mode::isosurface, .meaning = "surfaces of single values", .surfaces = true},
    {.mode = Mode::hybrid, .meaning = "the first surface, and the medium behind it", .surfaces = true, .medium = true},
};

}  // namespace

std::span<const ModelTraits> modelTraits() { return kModelTraits; }

const ModelTraits& traitsOf(Model model) {
  return *std::find_if(std::begin(kModelTraits), std::end(kModelTraits),
                       [&](const ModelTraits& traits) { return traits.model == model; });
}

const MethodTraits& traitsOf(Method method) {
  return *std::find_if(std::begin(kMethodTraits), std::end(kMethodTraits),
                       [&](const MethodTraits& traits) { return traits.method == method; });
}

std::optional<Method> occlusionMethod(const SceneSettings& scene) {
  if (!traitsOf(scene.model).occlusion) return std::nullopt;
  return scene.method;
}

void refuseConeRays(const SceneSettings& scene, std::string_view other) {
  if (occlusionMethod(scene) == Method::coneRays)
    throw InvalidArgument("method: cone-rays is of media by rays, not of " + std::string(other));
}

void checkConeRays(const SceneSettings& scene) {
  if (scene.mode == Mode::hybrid) refuseConeRays(scene, "surfaces");
  if (occlusionMethod(scene) != Method::coneRays) return;
  if (isShaded(scene)) throw InvalidArgument("shading.kind: phong takes light from a light volume, not from cone-rays");
  if (emits(scene))
    throw InvalidArgument("method: cone-rays takes no light that a second grid emits; emissionGrid must be none");
}

void requireClassification(const SceneSettings& scene) {
  if (scene.sampling.classification == Classification::pre && traitsOf(scene.model).occlusion)
    throw InvalidArgument("sampling.classification: pre is of the model emission alone, not of " +
                          modelName(scene.model));
  if (scene.sampling.classification == Classification::pre && emits(scene))
    throw InvalidArgument(
        "sampling.classification: pre interpolates media and no emission, but volume.emissionGrid is '" +
        scene.volume.emissionGrid + "'");
}

bool supports(Method method, Model model) {
  const ModelTraits& light = traitsOf(model);
  const MethodTraits& way = traitsOf(method);
  return !light.occlusion || (light.directions && (!light.sources || way.sources) && (!light.sphere || way.allAround));
}

std::span<const ModeTraits> modeTraits() { return kModeTraits; }

const ModeTraits& traitsOf(Mode mode) {
  return *std::find_if(std::begin(kModeTraits), std::end(kModeTraits),
                       [&](const ModeTraits& traits) { return traits.mode == mode; });
}

bool supports(Technique technique, Mode mode) { return mode == Mode::integrate || technique == Technique::rays; }

bool supportsMode(const SceneSettings& scene, Technique technique) {
  if (scene.mesh.shape && technique != Technique::rays) return false;
  if (emits(scene) && technique == Technique::shearWarp) return false;
  return supports(technique, scene.mode) && (!isShaded(scene) || scene.mode != Mode::integrate ||
                                             (technique != Technique::slices && technique != Technique::stacks));
}

void requireMode(const SceneSettings& scene, Technique technique) {
  if (isShaded(scene) && traitsOf(scene.mode).projection)
    throw InvalidArgument("shading.kind: phong is for surfaces and media; the mode " + modeName(scene.mode) +
                          " reflects no light");
  if (supportsMode(scene, technique)) return;
  std::string others;
  for (const auto& [name, other] : kTechniques)
    if (other != Technique::automatic && supportsMode(scene, other))
      others += (others.empty() ? "" : ", ") + std::string(name);
  const std::string what = !supports(technique, scene.mode)                   ? "mode: " + modeName(scene.mode)
                           : scene.mesh.shape && technique != Technique::rays ? "mesh: a scene with one"
                           : emits(scene)                                     ? "volume.emissionGrid: light of a grid"
                                                                              : "shading.kind: phong";
  throw InvalidArgument(what + " is not rendered by the technique " + techniqueName(technique) + " but by " + others);
}

bool emits(const SceneSettings& scene) {
  const std::string& grid = scene.volume.emissionGrid;
  return !grid.empty() && grid != kAutomaticGrid && (scene.mode == Mode::integrate || scene.mode == Mode::hybrid);
}

bool emissionLights(const SceneSettings& scene) {
  return emits(scene) && scene.mode == Mode::integrate && scene.emission.lightsMedium &&
         traitsOf(scene.model).occlusion && !isShaded(scene);
}

glm::dvec3 lightScale(const SceneSettings& scene) {
  return emissionLights(scene) && occlusionMethod(scene) == Method::lightVolume ? glm::dvec3(1) : scene.ambient;
}

bool isShaded(const SceneSettings& scene) {
  return scene.shading.kind == Shading::automatic ? traitsOf(scene.mode).surfaces
                                                  : scene.shading.kind == Shading::phong;
}

bool isMeshShaded(const SceneSettings& scene) { return scene.shading.kind != Shading::none; }

bool lightComesFromBehind(const SceneSettings& scene) {
  const ModelTraits& light = traitsOf(scene.model);
  return light.sphere || (light.sources && traitsOf(scene.method).allAround);
}

}  // namespace umbrick
