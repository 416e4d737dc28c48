#include "scene/names.h"

#include "umbrick/core/error.h"

namespace umbrick {

std::string modelName(Model model) { return std::string(nameOf(kModels, model)); }

std::string methodName(Method method) { return std::string(nameOf(kMethods, method)); }

Model parseModel(std::string_view name) {
  std::string known;
  for (const auto& [text, model] : kModels) {
    if (text == name) return model;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InvalidArgument("model: expected one of " + known + ", found '" + std::string(name) + "'");
}

void applyQuality(Quality quality, Scene& scene) {
  SamplingOptions& sampling = scene.sampling;
  sampling.spacingInVoxels = true;
  sampling.spacing = quality == Quality::draft ? 5 : quality == Quality::normal ? 2.5 : 1.25;
  sampling.segments = quality == Quality::draft ? 4 : quality == Quality::normal ? 4 : 2;
  scene.method = Method::ordinates;
  scene.occlusion.directions = quality == Quality::draft ? 6 : quality == Quality::normal ? 16 : 32;
  scene.occlusion.scale = 0;
}

}  // namespace umbrick
