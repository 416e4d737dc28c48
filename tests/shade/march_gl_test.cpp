// Compares emission and absorption of smooth fields with a ray march in double precision, and texel formats.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "shade/shade_fixture.h"
#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

const IndexBox kSmoothBlock{glm::ivec3(-8), glm::ivec3(39)};

// Returns a field with wavelengths of 13 to 25 voxels and values in (0, 1).
double smoothField(const glm::ivec3& i) {
  return 0.5 + 0.16 * (std::sin(0.41 * i.x + 0.2 * i.z) + std::cos(0.31 * i.y - 0.25 * i.x + 1) +
                       std::sin(0.35 * i.z + 0.2 * i.y + 2));
}

TransferFunction smoothTransfer() {
  return TransferFunction({{0, {{0.9, 0.1, 0.3}, 0}}, {1, {{0.2, 0.8, 0.5}, 0.35}}});
}

// Returns the emission-absorption integral along a ray by `steps` midpoints, front to back.
glm::dvec4 march(const FieldBricks& volume, const TransferFunction& transfer, const ViewRay& ray,
                 const DepthInterval& kept, int steps) {
  glm::dvec3 colour(0);
  double through = 1;
  const double step = kept.length() / steps, length = step * ray.stretch();
  for (int i = 0; i < steps && step > 0; ++i) {
    const Medium medium = transfer(volume.trilinearWorld(ray.at(kept.first + (i + 0.5) * step)));
    const double alpha = -std::expm1(-medium.sigma_t * length);
    colour += through * alpha * medium.albedo;
    through *= 1 - alpha;
  }
  return {colour, 1 - through};
}

struct Reference {
  std::vector<glm::dvec4> pixels;
  double rmsError(const Image& image) const {
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      for (int c = 0; c < 4; ++c) {
        const double error = image.pixels[4 * i + static_cast<std::size_t>(c)] - pixels[i][c];
        sum += error * error;
      }
    return std::sqrt(sum / (4 * static_cast<double>(pixels.size())));
  }
};

Reference marchPicture(const FieldBricks& volume, const ResolvedScene& scene, int steps) {
  Reference reference;
  for (int y = 0; y < scene.camera.height; ++y)
    for (int x = 0; x < scene.camera.width; ++x) {
      const ViewRay ray = viewRay(scene.camera, x + 0.5, y + 0.5);
      reference.pixels.push_back(march(volume, scene.transfer, ray, keptDepths(ray, scene.clipPlanes), steps));
    }
  return reference;
}

}  // namespace

// There are four spacings, each half of the one before, and the root mean square error must fall by 4 each time. Slabs
// that clip planes cut differ from one spacing to the next, which leaves the order a little to chance.
TEST_CASE("A smooth field converges to a march in double precision at second order", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const glm::dvec3 centre = kMediumIndex.centre();
  for (const Camera& camera : {orthographicCamera(centre + glm::dvec3(30, -20, 25), centre, 40, 32),
                               perspectiveCamera(centre + glm::dvec3(-25, 18, 27), centre, 0.9, 32),
                               perspectiveCamera(centre, centre + glm::dvec3(9, 5, 1), 1.4, 32)}) {
    ResolvedScene scene = plainScene(smoothTransfer(), camera, 4);
    scene.clipPlanes = boxPlanes(kMediumIndex);
    const FieldBricks volume = fieldFor(scene, smoothField, kSmoothBlock);
    // The march takes 1200 steps over 45 voxels or less: its error is (0.04 / 0.5)^2 of that at the smallest spacing.
    const Reference exact = marchPicture(volume, scene, 1200);
    for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint}) {
      scene.sampling.quadrature = quadrature;
      double errors[4];
      for (int i = 0; i < 4; ++i) {
        scene.sampling.spacing = 4.0 / (1 << i);
        errors[i] = exact.rmsError(renderPicture(*context, volume, scene).colour);
      }
      INFO("midpoint " << (quadrature == Quadrature::midpoint) << ", errors " << errors[0] << ' ' << errors[1] << ' '
                       << errors[2] << ' ' << errors[3]);
      CHECK(std::log2(errors[1] / errors[3]) / 2 > 1.85);
      CHECK(errors[3] < 1e-3);
      CHECK(errors[1] < errors[0]);
      CHECK(errors[2] < errors[1]);
      CHECK(errors[3] < errors[2]);
    }
  }
}

// The pre-integrated table holds a peak narrower than a slab's change of value; a point sample misses it.
TEST_CASE("A thin shell of a steep field is seen by pre-integration at any phase of the slices", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  // The value z / 40 crosses a peak of width 0.02 (0.8 voxels): tau is the area of the peak times 40.
  const double sigma_t = 2;
  const TransferFunction transfer({{0.39, {{1, 1, 1}, 0}}, {0.4, {{1, 1, 1}, sigma_t}}, {0.41, {{1, 1, 1}, 0}}});
  const double tau = 0.5 * 0.02 * sigma_t * 40;
  for (const double phase : {0.0, 0.3, 1.1, 1.9}) {
    const Camera camera = orthographicCamera({16, 16, 60 + phase}, {16, 16, 0}, 20, 16);
    ResolvedScene scene = plainScene(transfer, camera, 2.5);
    const FieldBricks volume = fieldFor(
        scene, [](const glm::ivec3& i) { return i.z / 40.0; }, kSmoothBlock);
    const Picture picture = renderPicture(*context, volume, scene);
    INFO("phase " << phase);
    // The values are -0.225 to 1.05, so a bin is 0.00125, a sixteenth of the peak. Means from node to node are
    // exact. Between nodes the integral is a parabola: it is off by an eighth of its curvature, sigma_t / 0.01,
    // times a squared bin.
    const double error = 2 * 40 * sigma_t / 0.01 * 0.00125 * 0.00125 / 8;  // two slabs meet in the peak
    for (const int pixel : {0, 7, 15}) CHECK(std::abs(picture.colour.at(pixel, pixel)[3] + std::expm1(-tau)) < error);
  }
}

TEST_CASE("Texel formats agree within the error that they state", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Camera camera = perspectiveCamera({45, 38, 42}, kMediumIndex.centre(), 0.9, 32);
  // The values are grid units of a CT, which are not near [0, 1].
  const double low = -1000, high = 3000, sigma_t = 0.3;
  const TransferFunction transfer({{low, {{1, 0.5, 0.2}, 0}}, {high, {{1, 0.5, 0.2}, sigma_t}}});
  ResolvedScene scene = plainScene(transfer, camera, 0.5);
  scene.clipPlanes = boxPlanes(kMediumIndex);
  double longest = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
      longest = std::max(longest, keptDepths(ray, scene.clipPlanes).length() * ray.stretch());
    }
  for (const bool wholeNumbers : {false, true}) {
    const auto field = [&](const glm::ivec3& i) {
      const double value = low + (high - low) * smoothField(i);
      return wholeNumbers ? std::round(value) : value;
    };
    FieldBricks volume = fieldFor(scene, field, kSmoothBlock);
    if (wholeNumbers) volume.exactFormat = VoxelFormat::unorm16;
    scene.bricks.format = "float32";
    const Picture exact = renderPicture(*context, volume, scene);
    CHECK(exact.stats.formatError == 0);
    const double extent = static_cast<double>(volume.value.max) - volume.value.min;
    const struct {
      const char* name;
      double error;    // the most by which a voxel may be wrong
      double weights;  // the most that 8-bit weights add: 3 axes, half a step of 1/256, neighbours up to 250 apart
    } formats[] = {{"unorm8", 0.5 * extent / 255, 3 * 250 / 512.0},
                   {"unorm16", wholeNumbers ? 0.0 : 0.5 * extent / 65535, 0},
                   {"half", 1.0, 0},  // half the distance between half-floats from 2048 to 4096
                   {"auto", 0, 0}};
    for (const auto& [name, error, weights] : formats) {
      INFO(name << ", whole numbers " << wholeNumbers);
      scene.bricks.format = name;
      const Picture picture = renderPicture(*context, volume, scene);
      CHECK(picture.stats.formatError <= error * (1 + 1e-6));
      CHECK(picture.stats.formatError >= 0.9 * error);  // among so many voxels some are nearly the worst
      const double slope = sigma_t / (high - low);
      // A change of optical depth changes alpha by less than itself, and each slab rounds.
      CHECK(maxDifference(exact.colour, picture.colour) <=
            (picture.stats.formatError + weights) * slope * longest + 2e-5);
    }
    CHECK(parseVoxelFormat("auto", volume) == (wholeNumbers ? VoxelFormat::unorm16 : VoxelFormat::float32));
  }
}
