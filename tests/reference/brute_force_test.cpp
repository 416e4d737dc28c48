// The reference against an integrator that knows no blocks, no domain and no pieces: short steps through the
// interpolated voxels of the whole of space that a ray can meet anything in.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>

#include <catch2/catch.hpp>

#include "reference/reference_fixture.h"
#include "support/random_transfer.h"

using namespace umbrick;

namespace {

class BruteForce {
 public:
  BruteForce(const ScalarGrid& grid, const TransferFunction& transfer)
      : accessor_(grid.grid->getConstAccessor()),
        toIndex_(glm::inverse(grid.indexToWorld())),
        covariant_(glm::transpose(glm::inverse(glm::dmat3(grid.indexToWorld())))),
        transfer_(transfer) {}

  // Returns light and opacity of a ray, by the midpoint rule on steps of `step`, world units.
  glm::dvec4 integrate(const ViewRay& ray, double last, double step) {
    glm::dvec3 light(0);
    double transmittance = 1;
    const double length = step * ray.stretch();
    for (double depth = 0.5 * step; depth < last; depth += step) {
      const glm::dvec3 point(toIndex_ * glm::dvec4(ray.at(depth), 1));
      const Medium medium =
          transfer_(interpolated(point, [&](const glm::ivec3& i) { return value(i); }),
                    transfer_.is2d() ? interpolated(point, [&](const glm::ivec3& i) { return gradient(i); }) : 0);
      const double through = std::exp(-medium.sigma_t * length);
      light += transmittance * (1 - through) * medium.albedo;
      transmittance *= through;
    }
    return {light, 1 - transmittance};
  }

 private:
  double value(const glm::ivec3& i) { return accessor_.getValue(openvdb::Coord(i.x, i.y, i.z)); }
  double gradient(const glm::ivec3& i) {
    glm::dvec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 one(0);
      one[axis] = 1;
      difference[axis] = 0.5 * (value(i + one) - value(i - one));
    }
    return glm::length(covariant_ * difference);
  }
  template <class At>
  static double interpolated(const glm::dvec3& point, const At& at) {
    const glm::dvec3 low = glm::floor(point), f = point - low;
    double sum = 0;
    for (unsigned c = 0; c < 8; ++c) {
      const glm::ivec3 corner(c & 1, c >> 1 & 1, c >> 2 & 1);
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] ? f[axis] : 1 - f[axis];
      if (weight > 0) sum += weight * at(glm::ivec3(low) + corner);
    }
    return sum;
  }

  openvdb::FloatGrid::ConstAccessor accessor_;
  glm::dmat4 toIndex_;
  glm::dmat3 covariant_;
  const TransferFunction& transfer_;
};

// Returns a grid with random content up to the very border of the active voxels.
ScalarGrid randomGrid(std::mt19937& random, float background) {
  const glm::ivec3 dims(5 + static_cast<int>(uniform(random, 0, 5)), 4 + static_cast<int>(uniform(random, 0, 6)), 6);
  return makeFilled(
      dims, {-3, 6, static_cast<int>(uniform(random, 0, 9))},
      [&](const glm::ivec3&) { return uniform(random, 0, 1) < 0.3f ? background : uniform(random, 0, 100); },
      background);
}

// Returns a function of values in [0, 100] that shows nothing where empty space is.
TransferFunction randomFunction(std::mt19937& random, double background, bool twoD) {
  std::vector<double> values{background, background + 15 + 20 * uniform(random, 0, 1)}, gradients{0, 10, 40};
  values.push_back(values.back() + 30);
  values.push_back(values.back());  // two equal values make a step
  values.push_back(values.back() + 20);
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    points.push_back({values[i], randomMedium(random)});
    points.back().medium.sigma_t *= i == 0 ? 0 : 0.2;
  }
  if (!twoD) return TransferFunction(points);
  std::vector<Medium> media;
  for (std::size_t j = 0; j < gradients.size(); ++j)
    for (std::size_t i = 0; i < values.size(); ++i) {
      media.push_back(randomMedium(random));
      // Gradients are seen also where the value is that of empty space, but only where there is a gradient.
      media.back().sigma_t *= i == 0 && j == 0 ? 0 : 0.2;
    }
  return TransferFunction(values, gradients, media);
}

}  // namespace

TEST_CASE("The reference agrees with short steps through all of space on random scenes", "[reference][slow]") {
  std::mt19937 random(11);
  for (int trial = 0; trial < 24; ++trial) {
    const bool twoD = trial % 2 == 1;
    const float background = trial % 4 < 2 ? 0.0f : -20.0f;
    const ScalarGrid grid = trial % 3 == 0 ? withTransform(randomGrid(random, background), crookedTransform())
                                           : randomGrid(random, background);
    const TransferFunction transfer = randomFunction(random, background, twoD);
    const Box bounds = grid.worldBounds();
    const double size = glm::length(bounds.extent());
    Camera camera;
    camera.width = camera.height = 5;
    camera.projection = trial % 5 < 2 ? Projection::orthographic : Projection::perspective;
    camera = orbitCamera(bounds, 0.3 + trial, 0.4 * std::sin(trial), camera);
    const ResolvedScene scene = plainScene(transfer, camera, 0.5);
    ReferenceOptions options;
    options.tolerance = 1e-6;
    const Image found = renderReference(grid, scene, options).colour;
    BruteForce brute(grid, transfer);
    double largest = 0, opacity = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const double last = glm::length(camera.lookAt - camera.eye) + size;
        const glm::dvec4 expected = brute.integrate(viewRay(camera, x + 0.5, y + 0.5), last, size / 12'000);
        opacity = std::max(opacity, expected.a);
        for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(found.at(x, y)[c] - expected[c]));
      }
    INFO("scene " << trial << ", 2D " << twoD << ", largest opacity " << opacity);
    // A step of the function is met up to half a step of the ray too soon or too late. A step of the ray is at
    // most 1/500 of a voxel edge, the optical depth is up to 1 per voxel edge, and there are some twenty steps
    // of the function.
    CHECK(largest < 2e-3);
  }
}

// Cells that cross more points than the classifier looks at one by one take means over parts of the cell.
TEST_CASE("Points on the lines between two points change no picture, however many they are", "[reference]") {
  std::mt19937 random(12);
  for (int trial = 0; trial < 6; ++trial) {
    const ScalarGrid grid = withTransform(randomGrid(random, 0), crookedTransform());
    const TransferFunction coarse = randomFunction(random, 0, false);
    std::vector<TransferFunction::Point> points;
    constexpr int kParts = 1500;  // so that most cells of random values cross more than 512
    for (std::size_t i = 0; i + 1 < coarse.values().size(); ++i) {
      const double low = coarse.values()[i], extent = coarse.values()[i + 1] - low;
      points.push_back({low, coarse.media()[i]});
      if (extent == 0) continue;
      for (int k = 1; k < kParts; ++k) points.push_back({low + extent * k / kParts, coarse(low + extent * k / kParts)});
    }
    points.push_back({coarse.values().back(), coarse.media().back()});
    Camera camera;
    camera.width = camera.height = 8;
    camera = orbitCamera(grid.worldBounds(), 0.3 + trial, 0.2 * trial, camera);
    ReferenceOptions options;
    options.tolerance = 1e-6;
    const Image expected = renderReference(grid, plainScene(coarse, camera, 0.5), options).colour;
    const Image found = renderReference(grid, plainScene(TransferFunction(points), camera, 0.5), options).colour;
    double largest = 0;
    for (std::size_t i = 0; i < found.pixels.size(); ++i)
      largest = std::max(largest, double(std::abs(found.pixels[i] - expected.pixels[i])));
    INFO("scene " << trial);
    // A part is 1/512 of a cell, and is exact where values run evenly. Where they turn they do not, and a step of the
    // function that lies just there moves by up to half a part, at an optical depth of up to 1 per cell.
    CHECK(largest < 1.0 / 1024);
  }
}
