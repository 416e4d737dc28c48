// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/renderer.h"

namespace umbrick {

void Renderer::setScene(const ResolvedScene& scene) {
  if (scene_ && *scene_ == scene) return;
  update(scene);
  scene_ = scene;
}

void Renderer::setCamera(const Camera& camera) {
  ResolvedScene next = scene();
  next.camera = camera;
  setScene(next);
}

void Renderer::setTransfer(const TransferFunction& transfer) {
  ResolvedScene next = scene();
  next.transfer = transfer;
  setScene(next);
}

void Renderer::setClip(const std::vector<ClipPlane>& planes, const std::optional<Box>& box) {
  ResolvedScene next = scene();
  next.clipPlanes = planes;
  next.clipBox = box;
  setScene(next);
}

void Renderer::setLight(Model model, Method method, const std::vector<LightSource>& sources) {
  ResolvedScene next = scene();
  next.model = model;
  next.method = method;
  next.lights = sources;
  setScene(next);
}

void Renderer::setOcclusion(const OcclusionOptions& occlusion) {
  ResolvedScene next = scene();
  next.occlusion = occlusion;
  setScene(next);
}

void Renderer::setSampling(const SamplingOptions& sampling) {
  ResolvedScene next = scene();
  next.sampling = sampling;
  setScene(next);
}

Picture Renderer::render(const RenderSample& sample) {
  draw(sample);
  return read();
}

}  // namespace umbrick
