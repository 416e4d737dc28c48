// Tests directional occlusion with laws, closed forms, and a sweep on the CPU.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "shade/occlusion_sweep.h"

using namespace umbrick;

namespace {

TransferFunction blobTransfer() { return TransferFunction({{0, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.3, 0.8, 0.6}, 1.5}}}); }

ResolvedScene coneScene(const TransferFunction& transfer, const Camera& camera, double spacing) {
  ResolvedScene scene = plainScene(transfer, camera, spacing);
  scene.model = Model::cone;
  scene.sampling.quadrature = Quadrature::midpoint;
  return scene;
}

}  // namespace

// Two passes compute one after the other what multiple render targets compute at once, from the same lines
// of the shader.
TEST_CASE("Two passes a slice and multiple render targets agree to the last bit", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras())
    for (const int algorithm : {2, 3}) {
      ResolvedScene scene = coneScene(blobTransfer(), camera, 0.7);
      scene.sampling.quadrature = Quadrature::preintegrated;
      scene.sampling.saturation = SamplingOptions().saturation;
      scene.occlusion.dos.algorithm = algorithm;
      const FieldBricks volume = fieldFor(scene, blobs, kBlock);
      scene.occlusion.dos.passes = 1;
      const Picture one = renderPicture(*context, volume, scene, kLayers);
      scene.occlusion.dos.passes = 2;
      const Picture two = renderPicture(*context, volume, scene, kLayers);
      CHECK(maxDifference(one.colour, two.colour) == 0);
      CHECK(maxDifference(one.visibility, two.visibility) == 0);
      CHECK(one.depth.pixels == two.depth.pixels);
    }
}

// The two differ by single-precision coordinates: 6e-8 of an image of 40 pixels moves a lookup by 2e-6 pixels, where
// neighbours differ by up to 0.1, on each of some 50 slices.
TEST_CASE("The occlusion sweep agrees with one in double precision", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras())
    for (const double theta : {0.3, 1.0471975511965976, 1.4})
      for (const int footprint : {1, 2, 3, 4})
        for (const bool correction : {true, false}) {
          const bool perspective = camera.projection == Projection::perspective;
          if (!correction && (!perspective || footprint != 3)) continue;
          if (theta != 0.3 && footprint == 1) continue;  // the centre alone makes no cone
          const int algorithm = footprint % 2 ? 2 : 3;
          INFO("perspective " << perspective << ", theta " << theta << ", footprint " << footprint << ", algorithm "
                              << algorithm << ", correction " << correction);
          ResolvedScene scene = coneScene(blobTransfer(), camera, 0.8);
          scene.occlusion.aperture = theta;
          scene.occlusion.dos.footprint = footprint;
          scene.occlusion.dos.algorithm = algorithm;
          scene.occlusion.dos.perspectiveCorrection = correction;
          const FieldBricks volume = fieldFor(scene, blobs, kBlock);
          const Picture picture = renderPicture(*context, volume, scene, kLayers);
          const auto exact = sweepOcclusion(volume, scene, 80);
          double colour = 0, alpha = 0, visibility = 0, shadow = 0;
          for (std::size_t i = 0; i < exact.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c)
              colour = std::max(colour, std::abs(picture.colour.pixels[4 * i + c] - exact[i][c]));
            alpha = std::max(alpha, std::abs(picture.colour.pixels[4 * i + 3] - exact[i][3]));
            visibility = std::max(visibility, std::abs(picture.visibility.pixels[i] - exact[i][4]));
            shadow = std::max(shadow, exact[i][3] - exact[i][4]);
          }
          INFO("errors " << colour << ' ' << alpha << ' ' << visibility);
          CHECK(alpha < 1e-5);
          CHECK(visibility < 1e-5);
          // sigma_s is albedo times sigma_t, a parabola of the value, but linear between the 256 nodes of the
          // table: it is off by an eighth of its second derivative 2 * 0.6 * 1.5 times a squared bin, over a path
          // of some 10 units.
          CHECK(colour < 4e-5);
          CHECK(shadow > 0.3);  // there is something to compare
        }
}

// Every sample of the footprint lies at the slice distance, so both algorithms are one.
TEST_CASE("With an aperture of 0 Algorithms 2 and 3 are the same", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Camera& camera : blobCameras()) {
    ResolvedScene scene = coneScene(blobTransfer(), camera, 0.8);
    scene.occlusion.aperture = 0;
    const FieldBricks volume = fieldFor(scene, blobs, kBlock);
    scene.occlusion.dos.algorithm = 2;
    const Picture exact = renderPicture(*context, volume, scene, kLayers);
    scene.occlusion.dos.algorithm = 3;
    const Picture sliced = renderPicture(*context, volume, scene, kLayers);
    // A sum of nine products differs from the product of a sum by a few roundings per slice.
    CHECK(maxDifference(exact.colour, sliced.colour) < 80 * 4 * kFloatRounding);
    scene.occlusion.aperture = 0.5;
    scene.occlusion.dos.algorithm = 2;
    CHECK(maxDifference(renderPicture(*context, volume, scene).colour, sliced.colour) > 1e-3);
  }
}

// Slab i of a medium that fills the image is lit by exp(-sigma_t d i), however wide the cone; only the first slab is
// cut by a clip plane. All of it is seen through slabs of length d_e: a geometric series.
TEST_CASE("In a medium wider than the image light falls by each slab's transmittance", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.11, d = 0.9, first = 20.3, last = 47.2;
  const IndexBox wide{glm::ivec3(-32), glm::ivec3(63)};
  for (const bool perspective : {false, true})
    for (const double theta : {0.0, 0.8, 1.5})
      for (const int bits : {32, 16}) {
        INFO("perspective " << perspective << ", theta " << theta << ", bits " << bits);
        const Camera camera = perspective ? perspectiveCamera({16, 16, 63}, {16, 16, 0}, 0.7, 32)
                                          : orthographicCamera({16, 16, 63}, {16, 16, 0}, 30, 32);
        ResolvedScene scene =
            coneScene(TransferFunction({{0, {{1, 0.5, 0.25}, 0}}, {1, {{1, 0.5, 0.25}, sigma_t}}}), camera, d);
        scene.occlusion.aperture = theta;
        scene.occlusion.bits = bits;
        scene.clipPlanes = {{0, 0, -1, 63 - first}, {0, 0, 1, last - 63}};  // keeps depths first to last
        const FieldBricks volume = fieldFor(
            scene, [](const glm::ivec3&) { return 1.0; }, wide);
        const Picture picture = renderPicture(*context, volume, scene, kLayers);
        double worst = 0, worstDepth = 0;
        for (int y = 0; y < camera.height; ++y)
          for (int x = 0; x < camera.width; ++x) {
            const double stretch = viewRay(camera, x + 0.5, y + 0.5).stretch();
            double light = 1, through = 1, visibility = 0, depth = 0, rounding = 0;
            int slabs = 0;
            for (int i = 0; i * d < last; ++i) {
              const double kept = std::min((i + 1) * d, last) - std::max(i * d, first);
              if (kept <= 0) continue;
              const double alpha = -std::expm1(-sigma_t * kept * stretch);
              visibility += through * alpha * light;
              // The buffer is rounded to 24 bits once per slab, or to fixed point three times: the light that is
              // spread, a slab's transmittance and their product. Taps and exponentials round a few times more
              // in single precision.
              rounding +=
                  through * alpha * ((bits == 16 ? slabs * 1.5 * std::exp2(-16) : 0) + 10 * kFloatRounding * light);
              rounding += 2 * kFloatRounding;
              ++slabs;
              depth += through * alpha * (i + 0.5) * d;
              through *= 1 - alpha;
              light *= std::exp(-sigma_t * kept);
            }
            worst = std::max({worst, std::abs(picture.visibility.at(x, y)[0] - visibility) / rounding,
                              std::abs(picture.colour.at(x, y)[1] - 0.5 * visibility) / rounding});
            worstDepth = std::max(worstDepth, std::abs(picture.depth.at(x, y)[0] - depth / (1 - through)));
          }
        CHECK(worst < 1);
        CHECK(worstDepth < 1e-4);
      }
}

TEST_CASE("The layers of a thin slab are its depth and the light that it gets", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double depth = 20.3, thickness = 0.4, sigma_t = 0.5;
  const Camera camera = orthographicCamera({16, 16, 63}, {16, 16, 0}, 30, 16);
  ResolvedScene scene = coneScene(TransferFunction({{0, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, sigma_t}}}), camera, 0.7);
  scene.clipPlanes = {{0, 0, -1, 63 - depth}, {0, 0, 1, depth + thickness - 63}};
  const FieldBricks volume = fieldFor(scene, [](const glm::ivec3&) { return 1.0; }, {glm::ivec3(-32), glm::ivec3(63)});
  for (const Model model : {Model::emission, Model::cone}) {
    scene.model = model;
    const Picture picture = renderPicture(*context, volume, scene, kLayers);
    for (const int pixel : {0, 9}) {
      const float alpha = picture.colour.at(pixel, pixel)[3];
      CHECK(alpha == Approx(-std::expm1(-sigma_t * thickness)).epsilon(1e-4));
      CHECK(picture.visibility.at(pixel, pixel)[0] == Approx(alpha).epsilon(1e-6));  // lit in full
      // Slabs count at their middles.
      CHECK(std::abs(picture.depth.at(pixel, pixel)[0] - (depth + 0.5 * thickness)) < 0.5 * scene.sampling.spacing);
    }
  }
  scene.clipPlanes = {{0, 0, 1, -100}};
  const Picture empty = renderPicture(*context, volume, scene, kLayers);
  CHECK(empty.visibility.at(3, 3)[0] == 0);
  CHECK(std::isinf(empty.depth.at(3, 3)[0]));
}

// A plate of one voxel's thickness casts its shadow through empty space on another plate. Every carried slice takes the
// mean of the slice before over the footprint: the sum of what is dark stays, and its variance grows by that of the
// footprint and of the linear interpolation, f (1 - f) at a fraction f.
TEST_CASE("Carried light keeps its sum, and its variance grows as a walk's", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const int size = 96, front = 60, back = 20;
  // Values below 0 are the black occluder, values above it the white receiver. In between there is nothing, so that
  // nothing shows where rounding lets a slice see a little of the plane next to its own.
  const double occluderSigma = 0.3, receiverSigma = 0.5;
  const TransferFunction transfer({{-1, {{0, 0, 0}, occluderSigma}},
                                   {-0.1, {{0, 0, 0}, 0}},
                                   {0.1, {{1, 1, 1}, 0}},
                                   {1, {{1, 1, 1}, receiverSigma}}});
  const auto field = [&](const glm::ivec3& i) {
    if (i.z == front) return i.x >= 28 && i.x < 36 && i.y >= 30 && i.y < 34 ? -1.0 : 0.0;
    return i.z == back ? 1.0 : 0.0;
  };
  // Slice middles lie on planes of voxels, and a pixel is half a voxel wide.
  Camera camera = orthographicCamera({32, 32, 70.5}, {32, 32, 0}, 48, size);
  camera.up = {0, 1, 0};
  for (const double theta : {0.3, 0.7})
    for (const int footprint : {2, 3}) {
      INFO("theta " << theta << ", footprint " << footprint);
      ResolvedScene scene = coneScene(transfer, camera, 1);
      scene.bricks.interior = 8;
      scene.occlusion.aperture = theta;
      scene.occlusion.dos.footprint = footprint;
      const FieldBricks volume = fieldFor(scene, field, {glm::ivec3(0), glm::ivec3(63)});
      const Picture picture = renderPicture(*context, volume, scene, kLayers);
      scene.clipPlanes = {{0, 0, 1, -(back + 5.0)}};
      const Picture alone = renderPicture(*context, volume, scene);
      struct Moments {
        double sum = 0, x = 0, xx = 0, y = 0, yy = 0;
        void add(double weight, double px, double py) {
          sum += weight, x += weight * px, xx += weight * px * px, y += weight * py, yy += weight * py * py;
        }
        glm::dvec2 variance() const { return {xx / sum - x * x / (sum * sum), yy / sum - y * y / (sum * sum)}; }
      } occluder, shadow;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const double inFront = alone.colour.at(x, y)[3], both = picture.colour.at(x, y)[3];
          occluder.add(inFront, x, y);
          // The occluder itself is fully lit: only the receiver can lack visibility. Roundings of 1e-7 would add up
          // over the whole image, while a Gaussian has 1e-4 of its variance below 1e-6 of its height.
          const double dark = (both - picture.visibility.at(x, y)[0]) / (both - inFront);
          if (dark > 1e-6) shadow.add(dark, x, y);
        }
      REQUIRE(occluder.sum > 20);
      const double radius = std::tan(theta) * size / camera.viewHeight;  // pixels
      glm::dvec2 stepVariance(0);
      for (const glm::dvec2& point : diskGrid(footprint)) {
        const glm::dvec2 offset = radius * point, f = offset - glm::floor(offset);
        stepVariance += (offset * offset + f * (1.0 - f)) / static_cast<double>(footprint * footprint);
      }
      const glm::dvec2 grown = shadow.variance() - occluder.variance();
      const double steps = front - back - 1;
      CHECK(shadow.sum == Approx(occluder.sum).epsilon(1e-4));
      CHECK(grown.x == Approx(steps * stepVariance.x).epsilon(1e-3));
      CHECK(grown.y == Approx(steps * stepVariance.y).epsilon(1e-3));
    }
}

TEST_CASE("Clipping an occluder away lights what is behind it", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  // A roof over half of a floor, seen from above; the clip box takes the roof off.
  const auto field = [](const glm::ivec3& i) {
    return i.z >= 22 && i.z <= 26 && i.x <= 16 ? 1.0 : i.z >= 4 && i.z <= 8 ? 1.0 : 0.0;
  };
  const TransferFunction transfer({{0, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, 2}}});
  ResolvedScene scene = coneScene(transfer, orthographicCamera({16, 16, 50}, {16, 16, 0}, 28, 32), 0.5);
  const FieldBricks volume = fieldFor(scene, field, kBlock);
  const Picture roofed = renderPicture(*context, volume, scene, kLayers);
  scene.clipPlanes = {{0, 0, -1, 18}};
  const Picture open = renderPicture(*context, volume, scene, kLayers);
  scene.model = Model::emission;
  const Picture unoccluded = renderPicture(*context, volume, scene, kLayers);
  double litShare = 0, brightened = 0;
  for (int y = 8; y < 24; ++y) {
    // Beside the roof the floor lies in its shadow; without it the floor only shades itself.
    for (int x = 22; x < 24; ++x) brightened += (open.colour.at(x, y)[0] - roofed.colour.at(x, y)[0]) / 32;
    litShare += open.colour.at(8, y)[0] / open.colour.at(23, y)[0] / 16;
  }
  CHECK(brightened > 0.01);
  CHECK(litShare == Approx(1).epsilon(1e-3));  // no trace of the roof
  CHECK(maxDifference(unoccluded.visibility, open.visibility) > 0.1);
}
