// Media that are scaled by gradient magnitude, from a volume to its picture.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "support/small_blobs.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/reference/reference.h"
#include "umbrick/render/render.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const glm::dvec3 kSlope(0.02, 0.01, 0.04);  // per voxel

TransferFunction ramp() { return TransferFunction({{0, {{0.9, 0.5, 0.2}, 0.05}}, {2, {{0.3, 0.6, 0.9}, 0.4}}}); }

Volume linearVolume() {
  return Volume(
      makeFilled(glm::ivec3(32), glm::ivec3(0), [](const glm::ivec3& i) { return glm::dot(kSlope, glm::dvec3(i)); }),
      "linear");
}

// Clipped, so that neither eye nor light sees the faces of the volume, where gradients are others.
Scene linearScene() {
  Scene scene;
  scene.transfer = ramp();
  scene.orbit.reset();
  scene.camera = perspectiveCamera({40, 30, 80}, glm::dvec3(15.5), 0.3, 16);
  scene.clipBox = Box{glm::dvec3(8), glm::dvec3(24)};
  scene.sampling.spacing = 0.5;
  return scene;
}

Image drawn(const Volume& volume, const Scene& scene) {
  const ResolvedScene resolved = volume.resolve(scene);
  const auto bricks = volume.cutForCpu(resolved);
  return makeRenderer(*bricks, resolved)->render().colour;
}

}  // namespace

TEST_CASE("Where the gradient is the same everywhere, a ramp of it scales the medium", "[render][cpu]") {
  const Volume volume = linearVolume();
  const double gradient = glm::length(kSlope);
  // The largest gradient is that of what is active: half of the drop to the background at the corner is larger.
  CHECK(volume.largestGradient() > gradient);
  for (const Model model : {Model::emission, Model::cone}) {
    Scene scene = linearScene();
    scene.model = model;
    scene.transfer = ramp().scaled(0.3);
    const Image expected = drawn(volume, scene);
    CHECK(largestAlpha(expected) > 0.2);
    scene.transfer = ramp();
    scene.gradientOpacity = glm::dvec2(0.7, 1.7) * gradient;
    // Media of 2D functions are read from a table of value and gradient.
    CHECK(maxDifference(drawn(volume, scene), expected) < 2e-3);
    scene.gradientOpacity *= 100 / volume.largestGradient();
    scene.gradientUnit = GradientUnit::percent;
    CHECK(maxDifference(drawn(volume, scene), expected) < 2e-3);
    scene.gradientOpacity = glm::dvec2(1.2, 2) * gradient;
    scene.gradientUnit = GradientUnit::grid;
    CHECK(largestAlpha(drawn(volume, scene)) == 0);
  }
}

TEST_CASE("A ramp of the gradient shows the same on the CPU as in the reference", "[render][cpu]") {
  const Volume volume(blobGrid(), "blobs");
  Scene scene;
  scene.transfer = TransferFunction({{0.05, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.8}}});
  scene.orbit.reset();
  scene.camera = smallCameras()[1];
  scene.sampling.spacing = 0.25;
  const Image whole = drawn(volume, scene);
  scene.gradientOpacity = {20, 80};
  scene.gradientUnit = GradientUnit::percent;
  const Image seen = drawn(volume, scene);
  const ResolvedScene resolved = volume.resolve(scene);
  CHECK(resolved.gradientOpacity.y == Approx(0.8 * volume.largestGradient()));
  CHECK(maxDifference(seen, whole) > 0.1);
  // The error of slices at a quarter of a voxel, and of a table of 2D media.
  CHECK(maxDifference(seen, renderReference(volume.grid(), resolved).colour) < 1e-2);
}

TEST_CASE("Percent of the gradients of a volume that has none is refused", "[render]") {
  const Volume volume(makeVoxels({{{0, 0, 0}, 0.0f}, {{1, 0, 0}, 0.0f}}), "flat");
  Scene scene = linearScene();
  scene.gradientOpacity = {10, 40};
  scene.gradientUnit = GradientUnit::percent;
  CHECK_THROWS_WITH(volume.resolve(scene), Contains("percent of the largest gradient, which is 0 in this volume"));
}
