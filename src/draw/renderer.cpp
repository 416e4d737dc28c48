// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/renderer.h"

#include "draw/added_work.h"
#include "umbrick/draw/pixel_samples.h"

namespace umbrick {

std::vector<LightDirection> lightsOf(const ResolvedScene& scene, const RenderSample& sample) {
  return sample.lights.empty() ? lightDirections(scene, scene.occlusion.ordinates.directions) : sample.lights;
}

void addWork(RenderStats& sum, const RenderStats& other) {
  sum.polygons += other.polygons;
  sum.fragments += other.fragments;
  sum.uploadedBricks += other.uploadedBricks;
  sum.windowUpdates += other.windowUpdates;
  sum.geometryMs += other.geometryMs;
  sum.uploadMs += other.uploadMs;
  sum.sweepMs += other.sweepMs;
  sum.readMs += other.readMs;
  sum.passes.extinctionMs += other.passes.extinctionMs;
  sum.passes.windowsMs += other.passes.windowsMs;
  sum.passes.eyeMs += other.passes.eyeMs;
}

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

Picture Renderer::render(const RenderSample& sample, const std::function<void(std::size_t)>& beforeEach) {
  const auto samples = static_cast<std::size_t>(scene().sampling.pixelSamples);
  const auto drawOne = [&](std::size_t i) {
    if (beforeEach) beforeEach(i);
    return renderPixelSample(*this, i, sample);
  };
  if (samples == 1) return drawOne(0);
  PixelSampleMean mean;
  for (std::size_t i = 0; i < samples; ++i) mean.add(drawOne(i));
  return mean.mean();
}

}  // namespace umbrick
