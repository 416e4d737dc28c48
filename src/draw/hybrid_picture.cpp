// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/hybrid_picture.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "draw/added_work.h"
#include "umbrick/draw/value_picture.h"

namespace umbrick {
namespace {

// Adds what the medium took to what the surfaces took. Bricks that both hold count twice, as they do in memory.
void addMediumWork(RenderStats& sum, const RenderStats& medium) {
  addWork(sum, medium);
  sum.slices = medium.slices;
  sum.bricks = medium.bricks;
  sum.visibleBricks += medium.visibleBricks;
  sum.brickSlots += medium.brickSlots;
  sum.bufferBytes += medium.bufferBytes;
  sum.directions = std::max(sum.directions, medium.directions);
  sum.windowBytes = medium.windowBytes;
  sum.lightMs += medium.lightMs;
  sum.lightSpacing = std::max(sum.lightSpacing, medium.lightSpacing);
  sum.lightSpacingError = std::max(sum.lightSpacingError, medium.lightSpacingError);
}

}  // namespace

ResolvedScene mediumBehind(const ResolvedScene& scene) {
  ResolvedScene medium = scene;
  medium.mode = Mode::integrate;
  medium.surfaces.clear();
  medium.background.reset();
  return medium;
}

double startBehind(const ResolvedScene& scene, double depth, double opacity) {
  return 1 - opacity > scene.sampling.saturation ? depth : std::numeric_limits<double>::infinity();
}

Picture composite(const ResolvedScene& scene, FirstSurfaces surfaces, const Picture& medium) {
  Picture picture = std::move(surfaces.picture);
  for (std::size_t i = 0; i < picture.colour.pixels.size() / 4; ++i) {
    float* const pixel = &picture.colour.pixels[4 * i];
    const float* const behind = &medium.colour.pixels[4 * i];
    const double through = 1 - static_cast<double>(pixel[3]);
    glm::dvec4 sum;
    for (int c = 0; c < 4; ++c) sum[c] = pixel[c] + through * behind[c];
    if (!picture.opacity.pixels.empty()) {
      // Depths of nothing are infinite.
      const auto weighed = [](double opacity, double depth) { return opacity > 0 ? opacity * depth : 0; };
      float& opacity = picture.opacity.pixels[i];
      const double depth = weighed(opacity, picture.depth.pixels[i]) +
                           through * weighed(medium.opacity.pixels[i], medium.depth.pixels[i]);
      picture.visibility.pixels[i] += static_cast<float>(through * medium.visibility.pixels[i]);
      opacity = static_cast<float>(sum.w);
      picture.depth.pixels[i] = sum.w > 0 ? static_cast<float>(depth / sum.w) : std::numeric_limits<float>::infinity();
    }
    storeOver(scene, sum, pixel);
  }
  addMediumWork(picture.stats, medium.stats);
  return picture;
}

}  // namespace umbrick
