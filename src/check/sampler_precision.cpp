// SPDX-License-Identifier: Apache-2.0
#include "check/sampler_precision.h"

#include <algorithm>
#include <cmath>

#include "umbrick/core/error.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {
namespace {

// One brick whose voxels are 0 and 255 in turn along x, whole numbers that every format holds.
class Stripes final : public Bricks {
 public:
  Stripes(VoxelFormat format, bool gradients) {
    layout.interior = glm::ivec3(8);
    domain = {glm::ivec3(-1), glm::ivec3(8)};
    value = {0, 255};
    gradient = {0, 0};
    hasGradients = gradients;
    exactFormat = format;
    bricks = {{glm::ivec3(0), value, {0, 0}}};
  }
  void read(const glm::ivec3&, std::span<float> values, std::span<float> gradients) const override {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = i % static_cast<std::size_t>(layout.edge().x) % 2 == 0 ? 0.0f : 255.0f;
    std::fill(gradients.begin(), gradients.end(), 0.0f);
  }
};

// Returns the value of Stripes at a continuous index: voxel i has place i + 1 in the array.
double stripesAt(double x) {
  const double place = x + 1, share = place - std::floor(place);
  const bool odd = static_cast<int>(std::floor(place)) % 2 != 0;
  return 255 * (odd ? 1 - share : share);
}

}  // namespace

double samplerPrecision(const GlContext& context, const Bricks& volume, const std::string& texels) {
  const Stripes stripes(volume.exactFormat, volume.hasGradients);
  Scene scene;
  scene.orbit.reset();
  scene.transfer = volume.hasGradients ? TransferFunction({0, 255}, {0, 1}, std::vector<Medium>(4))
                                       : TransferFunction({{0, {}}, {255, {}}});
  scene.camera.projection = Projection::orthographic;
  scene.camera.eye = {3.5, -4, 3.5};
  scene.camera.lookAt = {3.5, 0, 3.5};
  scene.camera.up = {0, 0, 1};
  scene.camera.width = 1021;  // a prime number: no two pixels hit the same place between voxels
  scene.camera.height = 1;
  const double pixel = 7.5 / scene.camera.width;
  scene.camera.viewHeight = pixel;
  scene.sampling = {.spacing = 1};
  scene.spacingUnit = SpacingUnit::world;
  scene.bricks.culling = false;
  scene.bricks.format = texels;
  SliceRenderer renderer(context, stripes, resolveScene(scene, {}, stripes.indexToWorld));
  renderer.render();
  const Image row = renderer.probe(4);
  double worst = 0;
  for (int x = 0; x < row.width; ++x) {
    const double expected = stripesAt(3.5 + (x + 0.5 - 0.5 * row.width) * pixel);
    worst = std::max(worst, std::abs(static_cast<double>(row.at(x, 0)[0]) - expected) / 255);
  }
  return worst;
}

}  // namespace umbrick
