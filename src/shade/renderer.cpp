// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/renderer.h"

namespace umbrick {

void Renderer::setScene(const ResolvedScene& scene) {
  if (scene_ && *scene_ == scene) return;
  update(scene);
  scene_ = scene;
}

template <class Edit>
void Renderer::change(const Edit& edit) {
  ResolvedScene next = scene();
  edit(next);
  setScene(next);
}

void Renderer::setCamera(const Camera& camera) {
  change([&](ResolvedScene& next) { next.camera = camera; });
}

void Renderer::setTransfer(const TransferFunction& transfer) {
  change([&](ResolvedScene& next) { next.transfer = transfer; });
}

void Renderer::setClip(const std::vector<ClipPlane>& planes, const std::optional<Box>& box) {
  change([&](ResolvedScene& next) {
    next.clipPlanes = planes;
    next.clipBox = box;
  });
}

void Renderer::setLight(Model model, Method method, const std::vector<LightSource>& sources) {
  change([&](ResolvedScene& next) {
    next.model = model;
    next.method = method;
    next.lights = sources;
  });
}

void Renderer::setOcclusion(const OcclusionOptions& occlusion) {
  change([&](ResolvedScene& next) { next.occlusion = occlusion; });
}

void Renderer::setSampling(const SamplingOptions& sampling) {
  change([&](ResolvedScene& next) { next.sampling = sampling; });
}

Picture Renderer::render(const RenderSample& sample) {
  draw(sample);
  return read();
}

}  // namespace umbrick
