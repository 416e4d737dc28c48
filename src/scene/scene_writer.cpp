#include "core/json_writer.h"
#include "scene/light_json.h"
#include "scene/names.h"

namespace umbrick {
namespace {

std::string printed(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }
std::string printed(bool value) { return value ? "true" : "false"; }
std::string printed(int value) { return std::to_string(value); }

template <typename T, std::size_t N>
std::string printed(const Name<T> (&names)[N], T value) {
  return jsonString(std::string(nameOf(names, value)));
}

std::string printedVolume(const VolumeReference& volume) {
  JsonFields fields{{"file", jsonString(volume.file.string())}};
  if (!volume.grid.empty()) fields.emplace_back("grid", jsonString(volume.grid));
  return jsonObject(fields);
}

std::string printedCamera(const Camera& camera, const std::optional<Orbit>& orbit) {
  JsonFields fields{{"projection", printed(kProjections, camera.projection)}};
  if (orbit) {
    fields.emplace_back("azimuth", jsonDegrees(orbit->azimuth));
    fields.emplace_back("elevation", jsonDegrees(orbit->elevation));
  } else {
    fields.emplace_back("eye", printed(camera.eye));
    fields.emplace_back("lookAt", printed(camera.lookAt));
    fields.emplace_back("up", printed(camera.up));
    fields.emplace_back("viewHeight", jsonNumber(camera.viewHeight));
  }
  fields.emplace_back("fov", jsonDegrees(camera.fov));
  fields.emplace_back("near", jsonNumber(camera.nearDistance));
  fields.emplace_back("size", jsonArray({printed(camera.width), printed(camera.height)}));
  return jsonObject(fields);
}

std::string printedLight(const Scene& scene) {
  JsonFields fields{{"ambient", printed(scene.ambient)}};
  if (scene.background) fields.emplace_back("background", printed(*scene.background));
  std::vector<std::string> sources;
  for (const LightSource& source : scene.lights) sources.push_back(printLightSource(source));
  if (!sources.empty()) fields.emplace_back("sources", jsonArray(sources));
  return jsonObject(fields);
}

std::string printedSampling(const SamplingOptions& sampling) {
  return jsonObject({{"spacing", jsonNumber(sampling.spacing)},
                     {"unit", printed(kSpacingUnits, sampling.spacingInVoxels)},
                     {"quadrature", printed(kQuadratures, sampling.quadrature)},
                     {"segments", printed(sampling.segments)},
                     {"bits", printed(sampling.bits)},
                     {"saturation", jsonNumber(sampling.saturation)}});
}

std::string printedOcclusion(const OcclusionOptions& occlusion) {
  return jsonObject({{"theta", jsonDegrees(occlusion.aperture)},
                     {"footprint", printed(occlusion.footprint)},
                     {"passes", printed(occlusion.passes)},
                     {"algorithm", printed(occlusion.algorithm)},
                     {"perspectiveCorrection", printed(occlusion.perspectiveCorrection)},
                     {"bits", printed(occlusion.bits)},
                     {"directions", printed(occlusion.directions)},
                     {"scale", jsonNumber(occlusion.scale)}});
}

std::string printedClip(const Scene& scene) {
  JsonFields fields;
  std::vector<std::string> planes;
  for (const ClipPlane& plane : scene.clipPlanes) planes.push_back(jsonNumbers({plane.x, plane.y, plane.z, plane.w}));
  if (!planes.empty()) fields.emplace_back("planes", jsonArray(planes));
  if (scene.clipBox) fields.emplace_back("box", jsonArray({printed(scene.clipBox->min), printed(scene.clipBox->max)}));
  return jsonObject(fields);
}

std::string printedBricks(const BrickSettings& bricks) {
  return jsonObject({{"bricked", printed(bricks.bricked)},
                     {"interior", printed(bricks.interior)},
                     {"culling", printed(bricks.culling)},
                     {"format", jsonString(bricks.format)},
                     {"budgetMiB", std::to_string(bricks.budgetMiB)}});
}

}  // namespace

std::string printScene(const Scene& scene) {
  JsonFields fields;
  if (scene.volume != VolumeReference{}) fields.emplace_back("volume", printedVolume(scene.volume));
  fields.emplace_back("camera", printedCamera(scene.camera, scene.orbit));
  if (scene.transfer) fields.emplace_back("transfer", printTransferFunction(*scene.transfer));
  fields.emplace_back("model", printed(kModels, scene.model));
  fields.emplace_back("method", printed(kMethods, scene.method));
  fields.emplace_back("light", printedLight(scene));
  fields.emplace_back("sampling", printedSampling(scene.sampling));
  fields.emplace_back("occlusion", printedOcclusion(scene.occlusion));
  if (!scene.clipPlanes.empty() || scene.clipBox) fields.emplace_back("clip", printedClip(scene));
  fields.emplace_back("bricks", printedBricks(scene.bricks));
  return jsonObject(fields);
}

}  // namespace umbrick
