// A camera that moves a little changes the picture a little: nothing pops as slices, bricks, their number, culling and
// the rejection of saturated pixels shift. Soft balls and a hard-edged wall, in many bricks.
// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <string>

#include "shade/hard_case.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

namespace {

constexpr int kEdge = 48;  // edge of the volume, voxels of unit size
constexpr double kSigma = 0.6, kSpacing = 0.5;

ScalarGrid ballsAndWall() {
  const openvdb::FloatGrid::Ptr grid = makeSparse({0, 0, 0}, 4, 7, kEdge).grid->deepCopy();
  grid->fill(openvdb::CoordBBox(openvdb::Coord(6, 30, 4), openvdb::Coord(40, 33, 44)), 1.0f);
  return makeGrid(grid);
}

// A path of the camera: the camera of a step i, which may be a fraction, and how far along its view axis a point of the
// volume moves at most per step.
struct Path {
  std::string name;
  std::function<Camera(double)> camera;
  double depthPerStep;  // world units
  int steps;
};

std::vector<Path> paths(int size) {
  const Box bounds{glm::dvec3(0), glm::dvec3(kEdge)};
  std::vector<Path> result;
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    Camera base;
    base.width = base.height = size;
    base.projection = projection;
    const double step = 0.05 * 3.14159265358979323846 / 180;
    const std::string name = projection == Projection::perspective ? "perspective" : "parallel";
    result.push_back({name + " orbit", [=](double i) { return orbitCamera(bounds, 0.5 + i * step, 0.3, base); },
                      0.5 * std::sqrt(3.0) * kEdge * step, 45});
  }
  // The camera moves from outside through a corner ball into the volume, a fifth of a slab at a time.
  Camera base = result[1].camera(0);
  base.fov = 0.9;
  const glm::dvec3 forward = glm::normalize(base.lookAt - base.eye);
  result.push_back({"dolly",
                    [=](double i) {
                      Camera camera = base;
                      camera.eye = bounds.centre() - forward * (29 - 0.1 * i);
                      camera.lookAt = camera.eye + forward;
                      return camera;
                    },
                    0.1, 45});
  return result;
}

ResolvedScene sceneOf(Model model, const Path& path) {
  const TransferFunction transfer({{0, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.9, 0.5, 0.2}, kSigma}}});
  ResolvedScene scene = plainScene(transfer, path.camera(0), kSpacing);
  scene.model = model;
  scene.bricks.interior = 8;
  scene.occlusion.aperture = 0.8;
  scene.sampling.saturation = SamplingOptions().saturation;
  return scene;
}

// Returns the largest change of a channel among a pixel and its neighbours.
double changeAround(const Image& a, const Image& b, int x, int y, int channel) {
  float most = 0;
  for (int j = std::max(0, y - 1); j <= std::min(a.height - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(a.width - 1, x + 1); ++i)
      most = std::max(most, std::abs(a.at(i, j)[channel] - b.at(i, j)[channel]));
  return most;
}

// Renders the path and compares each step with the reference's: in every pixel
//   change of the renderer <= factor * change of the reference there or in a neighbouring pixel + slack
// The slack is what the method itself may change by, however little the camera moves, or while it moves by a step:
//   - pixels whose transmittance is below `saturation` are shaded no more;
//   - the error of slabs is about periodic in where the slices lie. If it is E at most, it changes by 2 pi E per slab's
//     thickness that a point moves along the view axis. E is measured, of the emission of the same path.
void checkPath(const GlContext& context, const Path& path, Model model, double factor) {
  const ScalarGrid grid = ballsAndWall();
  ResolvedScene scene = sceneOf(model, path), plain = sceneOf(Model::emission, path);
  const auto volume = bricksFor(grid, scene);
  SliceRenderer renderer(context, *volume, scene), emission(context, *volume, plain);
  // V is sampled at points at fixed distances, so that the reference does not pop; its error does not matter here.
  ReferenceOptions smooth;
  smooth.step = model == Model::cone ? 2 : 0;
  smooth.directions = 6;
  std::vector<Image> images, exact;
  double error = 0;
  for (int i = 0; i <= path.steps; ++i) {
    scene.camera = plain.camera = path.camera(i);
    images.push_back(renderer.render(scene.camera).colour);
    exact.push_back(renderReference(grid, scene, smooth).colour);
    if (model == Model::emission)
      error = std::max(error, maxDifference(images.back(), exact.back()));
    else if (i % 5 == 0)
      error = std::max(error, maxDifference(emission.render(scene.camera).colour, renderReference(grid, plain).colour));
  }
  const double shift = path.depthPerStep / kSpacing;
  const double slack = scene.sampling.saturation + 2 * 3.14159265358979323846 * shift * error;
  double most = 0, mostExact = 0, excess = 0;
  for (std::size_t i = 1; i < images.size(); ++i) {
    mostExact = std::max(mostExact, maxDifference(exact[i], exact[i - 1]));
    for (int y = 0; y < images[i].height; ++y)
      for (int x = 0; x < images[i].width; ++x)
        for (int c = 0; c < 4; ++c) {
          const double change = std::abs(images[i].at(x, y)[c] - images[i - 1].at(x, y)[c]);
          most = std::max(most, change);
          excess = std::max(excess, change - factor * changeAround(exact[i], exact[i - 1], x, y, c));
        }
  }
  INFO("most that a pixel changes per step " << most << ", in the reference " << mostExact << "; beyond " << factor
                                             << " times that " << excess << " of " << slack << "; error " << error);
  CHECK(error < kSigma * kSpacing * kSpacing / 8);  // at a kink of slope 1 per voxel, as the wall's faces have
  CHECK(mostExact > 0.002);
  CHECK(most < 2 * mostExact);
  CHECK(excess < slack);
}

// Looks at steps of 1 / 1024 of a step of the path, in the halves where the picture changes most. A slope leaves a
// thousandth of its change or, where it is steep for a while, some times as much; a jump stays what it is.
double largestJump(SliceRenderer& renderer, const Path& path, int every, double& largestStep) {
  double jump = 0;
  for (int step = 0; step < path.steps; step += every) {
    double from = step, to = step + 1;
    Image a = renderer.render(path.camera(from)).colour, b = renderer.render(path.camera(to)).colour;
    largestStep = std::max(largestStep, maxDifference(a, b));
    for (int halving = 0; halving < 10; ++halving) {
      const double middle = 0.5 * (from + to);
      Image m = renderer.render(path.camera(middle)).colour;
      const bool first = maxDifference(a, m) > maxDifference(m, b);
      (first ? to : from) = middle;
      (first ? b : a) = std::move(m);
    }
    jump = std::max(jump, maxDifference(a, b));
  }
  return jump;
}

// @param every  only steps of the path that are so many apart are looked at
void checkJumps(Model model, int size, int every) {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = ballsAndWall();
  for (const Path& path : paths(size))
    for (const double saturation : {0.0, 1e-3}) {
      ResolvedScene scene = sceneOf(model, path);
      scene.sampling.saturation = saturation;
      const auto volume = bricksFor(grid, scene);
      SliceRenderer renderer(*context, *volume, scene);
      double step = 0;
      const double jump = largestJump(renderer, path, every, step);
      INFO(path.name << ", saturation " << saturation << ": largest step " << step << ", largest jump " << jump);
      CHECK(step > 0.002);
      CHECK(jump < saturation + 8 * step / 1024 + 3e-5);
    }
}

}  // namespace

TEST_CASE("A camera that moves in small steps changes emission as little as the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Path& path : paths(24)) {
    INFO(path.name);
    checkPath(*context, path, Model::emission, 1);
  }
}

// Shadows of dos are narrower than those of the cone, sqrt(d / L) as wide at a distance L: their edges move over a
// pixel in less time, for those of near occluders in half of it.
TEST_CASE("A camera that moves in small steps changes occlusion as little as the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  for (const Path& path : paths(16)) {
    INFO(path.name);
    checkPath(*context, path, Model::cone, 2);
  }
}

// With early rejection a pixel may jump by the transmittance at which it is left. The light that tiles and regions
// leave out is 1e-5 to 3e-5 (see screen_region.h, light_tiles.cpp).
TEST_CASE("No step of the camera is so small that emission jumps", "[shade][gl][slow]") {
  checkJumps(Model::emission, 24, 8);
}
TEST_CASE("No step of the camera is so small that occlusion jumps", "[shade][gl][slow]") {
  checkJumps(Model::cone, 40, 22);
}
