// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/pixel_samples.h"

#include <glm/common.hpp>
#include <string>
#include <utility>
#include <vector>

#include "draw/added_work.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pixel_points.h"

namespace umbrick {

Picture renderPixelSample(Renderer& renderer, std::size_t index, const RenderSample& sample) {
  const std::vector<glm::dvec2> points = pixelPoints(renderer.scene().sampling.pixelSamples);
  if (index >= points.size())
    throw InvalidArgument("pixel sample: expected one of " + std::to_string(points.size()) +
                          ", counted from 0, found " + std::to_string(index));
  RenderSample moved = sample;
  if (points.size() > 1) moved.pixel = glm::fract(points[index] + (sample.pixel - 0.5));
  renderer.draw(moved);
  return renderer.read();
}

void PixelSampleMean::add(Picture picture) {
  sum_.add(picture);
  const RenderStats before = std::exchange(last_, std::move(picture)).stats;
  addWork(last_.stats, before);
}

Picture PixelSampleMean::mean() const {
  Picture picture = last_;
  sum_.store(picture);
  return picture;
}

}  // namespace umbrick
