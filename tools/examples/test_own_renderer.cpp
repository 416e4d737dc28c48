// A test of a renderer of one's own against the reference: replace MyRenderer by yours.
//   test_own_renderer VOLUME
// Prints how far off it is at steps of 1, 1/2 and 1/4 voxel, and fails where the finest is not good enough.
// Renderers in other languages are tested by files in place of calls: umbrick check --export.
// SPDX-License-Identifier: Apache-2.0
#include <umbrick/brick/bricks.h>
#include <umbrick/image/image_difference.h>
#include <umbrick/reference/reference.h>
#include <umbrick/render/volume.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <glm/glm.hpp>
#include <map>
#include <vector>

namespace {

/// Marches through bricks in equal steps, one ray after the other: as simple as a renderer can be.
class MyRenderer {
 public:
  explicit MyRenderer(const umbrick::Bricks& bricks) : layout_(bricks.layout), background_(bricks.background) {
    for (const umbrick::Brick& brick : bricks.bricks) {
      std::vector<float>& voxels = bricks_[{brick.origin.x, brick.origin.y, brick.origin.z}];
      voxels.resize(layout_.voxels());
      bricks.read(brick.origin, voxels);
    }
    toIndex_ = glm::inverse(bricks.indexToWorld);
    middle_ = 0.5 * (glm::dvec3(bricks.domain.min) + glm::dvec3(bricks.domain.max));
    diagonal_ = glm::length(glm::dvec3(bricks.domain.extent()));
  }

  umbrick::Image render(const umbrick::ResolvedScene& scene, double stepVoxels) const {
    const umbrick::CameraFrame frame = umbrick::cameraFrame(scene.camera);
    const umbrick::ScreenPlane screen = umbrick::screenPlane(scene.camera);
    umbrick::Image image(scene.camera.width, scene.camera.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * screen.pixelSize - screen.halfExtent;
        march(scene, glm::normalize(frame.forward + p.x * frame.right + p.y * frame.up), stepVoxels, image.at(x, y));
      }
    return image;
  }

 private:
  void march(const umbrick::ResolvedScene& scene, const glm::dvec3& direction, double stepVoxels, float* pixel) const {
    const glm::dvec3 eye(toIndex_ * glm::dvec4(scene.camera.eye, 1)), along(toIndex_ * glm::dvec4(direction, 0));
    const double ds = stepVoxels / glm::length(along);  // world units
    const double begin = std::max(0.0, glm::length(eye - middle_) - 0.5 * diagonal_);
    double through = 1;
    for (double s = 0.5; s * stepVoxels < diagonal_ && through > 1e-4; ++s) {
      const umbrick::Medium medium = scene.transfer(value(eye + (begin / glm::length(along) + s * ds) * along));
      const double kept = std::exp(-medium.sigma_t * ds);  // what a step of this length lets through
      for (int c = 0; c < 3; ++c) pixel[c] += static_cast<float>(through * (1 - kept) * medium.albedo[c]);
      through *= kept;
    }
    pixel[3] = static_cast<float>(1 - through);
  }

  // Interpolates in the one brick that owns the point; its apron has the neighbours' voxels.
  double value(const glm::dvec3& p) const {
    const glm::dvec3 interior(layout_.interior);
    const glm::ivec3 origin(glm::floor((p + 0.5) / interior) * interior), edge = layout_.edge();
    const auto brick = bricks_.find({origin.x, origin.y, origin.z});
    if (brick == bricks_.end()) return background_;
    const glm::dvec3 t = glm::fract(p);
    const glm::ivec3 first = glm::ivec3(glm::floor(p)) - origin + layout_.apron;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2), at = first + offset;
      const glm::dvec3 weight = glm::mix(1.0 - t, t, glm::dvec3(offset));
      sum += weight.x * weight.y * weight.z *
             brick->second[static_cast<std::size_t>((at.z * edge.y + at.y) * edge.x + at.x)];
    }
    return sum;
  }

  umbrick::BrickLayout layout_;
  double background_, diagonal_;
  glm::dmat4 toIndex_;
  glm::dvec3 middle_;
  std::map<std::array<int, 3>, std::vector<float>> bricks_;
};

}  // namespace

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: test_own_renderer VOLUME\n");
    return 2;
  }
  umbrick::Scene scene;
  scene.volume.file = arguments[1];
  scene.camera.width = 64;
  scene.camera.height = 48;
  const umbrick::Volume volume(scene.volume);
  const umbrick::ResolvedScene resolved = volume.resolve(scene);  // with a transfer function and a camera that fit
  const umbrick::Image truth = umbrick::renderReference(volume.grid(), resolved).colour;
  const auto bricks = volume.cutForCpu(resolved);
  const MyRenderer renderer(*bricks);

  double rmse = 1;
  for (const double step : {1.0, 0.5, 0.25}) {
    rmse = umbrick::differenceOf(renderer.render(resolved, step), truth).rmse;
    std::printf("steps of %g voxel: RMSE %.2g\n", step, rmse);
  }
  const bool good = rmse < 1e-4;
  std::printf("%s\n", good ? "ok" : "FAILED");
  return good ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "test_own_renderer: %s\n", error.what());
  return 1;
}
