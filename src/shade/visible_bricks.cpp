// SPDX-License-Identifier: Apache-2.0
#include "shade/visible_bricks.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

std::vector<std::int32_t> visibleBricks(ResidentVolume& resident, const TransferLookup& transfer, bool culling,
                                        bool backgroundVisible) {
  const std::vector<Brick>& bricks = resident.volume().bricks;
  std::vector<std::int32_t> visible;
  for (std::size_t i = 0; i < bricks.size(); ++i)
    if (!culling || transfer.isVisible(bricks[i].value, bricks[i].gradient, bricks[i].emission))
      visible.push_back(static_cast<std::int32_t>(i));
  if (backgroundVisible) {
    const std::span<const std::int32_t> background = resident.background();
    visible.insert(visible.end(), background.begin(), background.end());
  }
  return visible;
}

bool showsBackground(const TransferLookup& transfer, const Bricks& volume) {
  return !volume.domain.empty() && transfer.isVisible({volume.background, volume.background}, {0, 0});
}

SlotSharing sharingOf(const ResolvedScene& scene) {
  return occlusionMethod(scene) == Method::lightVolume ? SlotSharing::apart : SlotSharing::shared;
}

void checkOnGl(const ResolvedScene& scene, const ResidentVolume& resident) {
  if (scene.sampling.classification == Classification::pre)
    throw InvalidArgument(
        "sampling.classification: pre is rendered on the CPU, by rays and by shear-warp, and without occlusion");
  if (scene.transfer.is2d()) requireGradients(resident.volume(), scene.gradients);
  if (scene.emitted) {
    if (!resident.volume().hasEmission)
      throw InvalidArgument("volume.emissionGrid: '" + scene.volume.emissionGrid +
                            "' needs bricks with the values of that grid, which there are none of");
    if (scene.sampling.bits == 16)
      throw InvalidArgument("sampling.bits: 16 holds radiance up to 1, and what a grid emits may be more; must be 32");
    requireDarkBackground(*scene.emitted, resident.volume().emissionBackground);
  }
  checkSize(scene, resident.context());
}

void checkSize(const ResolvedScene& scene, const GlContext& context) {
  const int most = context.maxTextureEdge2d();
  if (scene.camera.width > most || scene.camera.height > most)
    throw InvalidArgument("camera.size: " + std::to_string(scene.camera.width) + " x " +
                          std::to_string(scene.camera.height) + " is beyond the driver's limit of " +
                          std::to_string(most) + " pixels along an edge");
}

void readLayers(const GlFunctions& gl, const RenderTargets& targets, const ResolvedScene& scene, double brightest,
                Picture& picture) {
  const int width = scene.camera.width, height = scene.camera.height;
  picture.colour = readTexture(gl, targets.eye, width, height);
  // Beside emission the ambient radiance is in what shaders write.
  const glm::vec3 ambient = scene.emitted ? glm::vec3(1) : glm::vec3(scene.ambient);
  const auto unit = static_cast<float>(brightest);
  for (std::size_t i = 0; i < picture.colour.pixels.size(); i += 4) {
    float* pixel = &picture.colour.pixels[i];
    pixel[3] = std::min(pixel[3], 1.0f);  // it is at most 1 except for rounding
    const float through = 1 - pixel[3];
    for (int c = 0; c < 3; ++c) {
      pixel[c] *= unit * ambient[c];
      if (scene.background) pixel[c] += through * static_cast<float>((*scene.background)[c]);
    }
    if (scene.background) pixel[3] = 1;
  }
  if (!targets.options.aux) return;
  const Image aux = readTexture(gl, targets.aux, width, height);
  picture.visibility = Image(width, height, 1);
  picture.depth = Image(width, height, 1);
  picture.opacity = Image(width, height, 1);
  for (std::size_t i = 0; i < picture.depth.pixels.size(); ++i) {
    const float* pixel = &aux.pixels[4 * i];
    picture.visibility.pixels[i] = pixel[0];
    picture.opacity.pixels[i] = std::min(pixel[3], 1.0f);
    picture.depth.pixels[i] = pixel[3] > 0 ? pixel[1] / pixel[3] : std::numeric_limits<float>::infinity();
  }
}

void addTextures(const BrickAtlas& atlas, RenderStats& stats) {
  stats.textureBytes = atlas.textureBytes();
  stats.textures = atlas.textureCount();
  const glm::ivec3 size = atlas.textureSize();
  stats.textureEdge = std::max({size.x, size.y, size.z});
  stats.formatError = atlas.formatError();
}

}  // namespace umbrick
