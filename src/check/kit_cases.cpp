// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/kit_cases.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "umbrick/check/invariants.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"
#include "umbrick/core/transformed_box.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// Not square, so that a picture whose axes are exchanged does not even have the right size.
constexpr int kKitWidth = 64, kKitHeight = 48;
constexpr int kKitInterior = 8;
constexpr double kDegree = std::numbers::pi / 180;

ScalarGrid gridOf(openvdb::FloatGrid::Ptr grid, const glm::dmat4& indexToWorld) {
  grid->setTransform(openvdb::math::Transform::createLinearTransform(rowMatrix(indexToWorld)));
  grid->setName("density");
  ScalarGrid result;
  result.grid = std::move(grid);
  result.name = "density";
  return result;
}

// Makes active voxels of a box; those of the background's value stay inactive.
ScalarGrid filled(const IndexBox& box, const glm::dmat4& indexToWorld, float background,
                  const std::function<double(const glm::ivec3& offset)>& value) {
  const auto grid = openvdb::FloatGrid::create(background);
  auto voxels = grid->getAccessor();
  for (int z = box.min.z; z <= box.max.z; ++z)
    for (int y = box.min.y; y <= box.max.y; ++y)
      for (int x = box.min.x; x <= box.max.x; ++x) {
        const auto v = static_cast<float>(value(glm::ivec3(x, y, z) - box.min));
        if (v != background) voxels.setValue(openvdb::Coord(x, y, z), v);
      }
  return gridOf(grid, indexToWorld);
}

IndexBox boxAt(const glm::ivec3& first, const glm::ivec3& dims) { return {first, first + dims - 1}; }

glm::dmat4 scaled(double voxel, const glm::dvec3& place = glm::dvec3(0)) {
  return glm::scale(glm::translate(glm::dmat4(1), place), glm::dvec3(voxel));
}

// Bumps a few voxels wide, alike along no axis, in [0, 1], that end in nothing at the faces of a box of 20^3.
double bumps(const glm::ivec3& offset) {
  const glm::dvec3 p = glm::dvec3(offset) - 9.5;
  const double wave = std::sin(0.9 * p.x + 0.3 * p.y) * std::cos(0.7 * p.y - 0.2 * p.z) + 0.6 * std::sin(0.8 * p.z);
  const double fall = std::max(0.0, 1 - glm::dot(p, p) / 90.25);
  return std::clamp(0.5 + 0.45 * wave, 0.0, 1.0) * fall;
}

// Extinction and colour rise with the value from nothing at `low`.
TransferFunction rising(double sigma_t, double low = 0, double high = 1) {
  return TransferFunction({{low, {{0.9, 0.4, 0.1}, 0}}, {high, {{0.2, 0.7, 0.9}, sigma_t}}});
}

Scene kitScene(TransferFunction transfer) {
  Scene scene;
  scene.transfer = std::move(transfer);
  scene.camera.width = kKitWidth;
  scene.camera.height = kKitHeight;
  scene.bricks.interior = kKitInterior;
  return scene;
}

// Adds a view around all that interpolation may reach: a voxel more than is active.
void addOrbit(KitCase& kit, const std::string& name, Scene scene, double azimuth, double elevation,
              Projection projection) {
  const glm::dmat4 toWorld = kit.grid.indexToWorld();
  const IndexBox active = kit.grid.activeBox();
  scene.camera.projection = projection;
  scene.orbit = Orbit{azimuth * kDegree, elevation * kDegree};
  const Box reach{glm::dvec3(active.min) - 1.0, glm::dvec3(active.max) + 1.0};
  kit.views.push_back({name, resolveScene(scene, transformed(reach, toWorld), toWorld)});
}

void addUsualViews(KitCase& kit, const Scene& scene) {
  addOrbit(kit, "front", scene, 0, 0, Projection::orthographic);
  addOrbit(kit, "oblique", scene, 35, 25, Projection::perspective);
}

KitCase usual(std::string name, std::string purpose, ScalarGrid grid, TransferFunction transfer) {
  KitCase kit{std::move(name), std::move(purpose), std::move(grid), {}};
  addUsualViews(kit, kitScene(std::move(transfer)));
  return kit;
}

KitCase slab() {
  KitCase kit{
      "slab",
      "A slab of value 1, 16 voxels of 0.5 thick, of extinction 0.25: an optical depth of 16 x 0.5 x 0.25 = 2, so "
      "that the opacity in the middle of the picture front is 1 - exp(-2) = 0.86466. In backdrop, light comes "
      "through from behind.",
      filled(boxAt({-8, 4, -8}, {24, 16, 20}), scaled(0.5), 0, [](const auto&) { return 1.0; }),
      {}};
  Scene scene = kitScene(rising(0.25));
  addUsualViews(kit, scene);
  scene.background = glm::dvec3(0.2, 0.5, 0.9);
  addOrbit(kit, "backdrop", scene, 35, 25, Projection::perspective);
  return kit;
}

KitCase singleVoxel() {
  return usual("single-voxel",
               "One voxel at the corner of eight bricks: seven of them know it from their aprons alone. Nearest "
               "neighbours make a cube of it, which reaches half as far as interpolation does.",
               filled(boxAt({8, 8, 0}, {1, 1, 1}), scaled(1), 0, [](const auto&) { return 1.0; }), rising(2));
}

KitCase tiles() {
  const auto grid = openvdb::FloatGrid::create(0);
  const auto fill = [&](const openvdb::Coord& low, const openvdb::Coord& high, float value) {
    grid->tree().sparseFill({low, high}, value);
  };
  fill({-8, 0, 0}, {7, 15, 7}, 0.9f);
  fill({8, 0, 0}, {15, 7, 15}, 0.35f);
  return usual("tiles", "A .vdb without a leaf: its values are tiles. Who looks at leaves alone sees nothing.",
               gridOf(grid, scaled(1)), rising(0.3));
}

KitCase thinWall() {
  return usual("thin-wall",
               "A wall of one voxel on the first layer of a brick. Wide steps pass through it, and bricks that are "
               "culled by their own voxels alone, without their aprons, cut it in half.",
               filled(boxAt({8, 0, 0}, {1, 20, 20}), scaled(1), 0,
                      [](const glm::ivec3& p) { return 0.4 + 0.6 * (p.y + p.z) / 38.0; }),
               rising(3));
}

KitCase crooked() {
  glm::dmat4 matrix(1);
  matrix[0] = {-0.8, 0.1, 0.05, 0};  // mirrored
  matrix[1] = {0.25, 1.1, 0, 0};     // sheared
  matrix[2] = {0, -0.2, 0.6, 0};
  matrix[3] = {5, -3, 2, 1};
  return usual("crooked",
               "A transform that mirrors, shears and has voxels of three edges. Lengths along a ray are those of the "
               "world, not of index space.",
               filled(boxAt({-5, 2, -9}, {20, 20, 20}), matrix, 0, bumps), rising(0.6));
}

KitCase farOrigin() {
  return usual("far-origin",
               "Voxels of 1 at (1e6, -2e6, 5e5): world coordinates in single precision are 1/16 to 1/8 of a voxel "
               "apart there.",
               filled(boxAt({0, 0, 0}, {20, 20, 20}), scaled(1, {1e6, -2e6, 5e5}), 0, bumps), rising(0.4));
}

KitCase farIndex() {
  return usual("far-index",
               "Voxels of 0.01 with indices around (1000000, -2000000, 3000): the same for index coordinates, and "
               "indices below 0 are no multiples of the brick's edge when they are cut towards 0.",
               filled(boxAt({1000003, -2000011, 2997}, {20, 20, 20}), scaled(0.01), 0, bumps), rising(40));
}

KitCase steepShell() {
  return usual(
      "steep-shell",
      "Values that fall by about 1/12 a voxel from the middle, through a peak of the transfer function that is "
      "0.04 wide: a shell of half a voxel. Who samples twice a voxel without integrating in between sees rings, "
      "and who classifies before interpolation sees dots.",
      filled(boxAt({0, 0, 0}, {25, 25, 25}), scaled(1), 0,
             [](const glm::ivec3& p) {
               const glm::dvec3 q = (glm::dvec3(p) - 12.0) / glm::dvec3(12, 10, 11);
               return std::max(0.0, 1 - glm::length(q));
             }),
      TransferFunction({{0.48, {{1, 0.6, 0.2}, 0}}, {0.5, {{0.9, 0.9, 0.6}, 3}}, {0.52, {{0.3, 0.5, 1}, 0}}}));
}

KitCase opaque() {
  KitCase kit{"opaque",
              "An extinction of 1000 a voxel, straight from the front: opacity is 1, without infinities and NaN, and "
              "only the first hundredth of a voxel is seen.",
              filled(boxAt({0, 0, 0}, {20, 12, 14}), scaled(1), 0, [](const auto&) { return 1.0; }),
              {}};
  addOrbit(kit, "front", kitScene(rising(1000)), 0, 0, Projection::orthographic);
  return kit;
}

KitCase background() {
  return usual("background",
               "A background of -1000 around values of 300 and more, as air in a CT. What lies outside of the volume, "
               "and in aprons that reach out of it, is -1000 and not 0: else surfaces swell.",
               filled(boxAt({0, 0, 0}, {20, 20, 20}), scaled(1), -1000,
                      [](const glm::ivec3& p) {
                        const glm::dvec3 q = glm::dvec3(p) - glm::dvec3(9.5, 7, 11);
                        return glm::dot(q, q) < 60 ? 300 + 40.0 * p.x : -1000.0;
                      }),
               rising(0.8, -300, 1100));
}

KitCase insideEye() {
  KitCase kit{"inside",
              "The eye is inside the medium, between the voxels of a brick, and sees 100 degrees: what is behind it "
              "does not count, and rays begin at the eye.",
              filled(boxAt({0, 0, 0}, {20, 20, 20}), scaled(1), 0, bumps),
              {}};
  Scene scene = kitScene(rising(0.5));
  scene.orbit.reset();
  scene.camera.eye = {8.3, 7.6, 9.1};
  scene.camera.lookAt = {14, 15, 11};
  scene.camera.up = {0, 0, 1};
  scene.camera.fov = 100 * kDegree;
  const glm::dmat4 toWorld = kit.grid.indexToWorld();
  kit.views.push_back({"wide", resolveScene(scene, kit.grid.worldBounds(), toWorld)});
  return kit;
}

KitCase thread() {
  const auto grid = openvdb::FloatGrid::create(0);
  for (int i = 0; i < 30; ++i)
    grid->tree().setValue(openvdb::Coord(i - 6, (2 * i) / 3 - 3, i - 12), 1 - 0.02f * static_cast<float>(i));
  return usual("thread",
               "A thread of single voxels through the edges and corners of many bricks, each of which is nearly "
               "empty.",
               gridOf(grid, scaled(1)), rising(2.5));
}

KitCase noise() {
  Random random(7);
  return usual("noise", "Voxels that have nothing to do with their neighbours: every wrong weight is seen.",
               filled(boxAt({-3, 5, 1}, {18, 18, 18}), scaled(1), 0, [&](const auto&) { return random.uniform(); }),
               rising(0.5));
}

void requireSayable(const ResolvedScene& scene) {
  const auto refuse = [](const std::string& field, const std::string& found, const std::string& expected) {
    throw InvalidArgument(field + ": is " + found + ", and a kit for other renderers has " + expected);
  };
  if (scene.mode != Mode::integrate) refuse("mode", std::string(nameOf(kModes, scene.mode)), "integrate alone");
  if (scene.model != Model::emission) refuse("model", modelName(scene.model), "emission alone");
  if (isShaded(scene)) refuse("shading.kind", "phong", "none");
  if (scene.transfer.is2d()) refuse("transfer", "a function of value and gradient", "functions of the value alone");
  if (!scene.clipPlanes.empty()) refuse("clip.planes", "given", "no clip planes");
  if (scene.clipBox) refuse("clip.box", "given", "no clip box");
  if (scene.sampling.classification != Classification::post) refuse("sampling.classification", "pre", "post alone");
}

// Returns letters, digits and single hyphens.
std::string fileName(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain)
      name += c;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  while (name.ends_with('-')) name.pop_back();
  return name.empty() ? "volume" : name;
}

}  // namespace

std::vector<KitCase> hardCases() {
  return {slab(),       singleVoxel(), tiles(),      thinWall(),  crooked(), farOrigin(), farIndex(),
          steepShell(), opaque(),      background(), insideEye(), thread(),  noise()};
}

KitCase kitCaseOf(const std::string& name, const ScalarGrid& grid, const ResolvedScene& scene) {
  requireSayable(scene);
  ResolvedScene plain = scene;
  plain.sampling.pixelSamples = 1;
  KitCase kit{fileName(name), "A volume of the caller's.", grid, {{"scene", plain}}};
  for (const CheckView& view : checkViews(grid, plain)) {
    kit.views.push_back({fileName(view.name), plain});
    kit.views.back().scene.camera = view.camera;
  }
  return kit;
}

}  // namespace umbrick
