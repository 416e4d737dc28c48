// Renderers that live: what a change of the scene uploads, and that pictures are those of a renderer made for the
// scene. SPDX-License-Identifier: Apache-2.0
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "support/complaint.h"
#include "support/gl_fixture.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/render/render.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

// The bundled CT of a head, as the README converts it.
Volume headVolume() {
  RawOptions raw;
  raw.dims = {256, 256, 94};
  raw.type = VoxelType::u16;
  raw.bitsStored = 15;
  raw.spacing = {0.8, 0.8, 1.5};
  const auto source = openRaw(std::string(UMBRICK_ASSETS) + "/headsq_256x256x94_uint16le.raw.gz", raw);
  return Volume({buildGrid(*source).grid, "density"}, "head");
}

Scene headScene() {
  Scene scene;
  scene.transfer = loadTransferFunction("ct-head");
  scene.camera.width = scene.camera.height = 48;
  scene.sampling.spacing = 2;
  return scene;
}

// Bone alone: its bricks are among those of ct-head.
TransferFunction bone() { return loadTransferFunction("ct-bone"); }

Scene sparseScene() {
  Scene scene;
  scene.transfer = TransferFunction({{0, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.9, 0.5, 0.2}, 0.2}}});
  scene.camera.width = scene.camera.height = 40;
  scene.sampling.spacing = 2;
  scene.occlusion.ordinates.directions = 6;
  return scene;
}

// The same medium from `least` on.
TransferFunction above(double least) {
  const glm::dvec3 albedo(0.9, 0.5, 0.2);
  return TransferFunction({{least, {albedo, 0}}, {1, {albedo, 0.3}}});
}

}  // namespace

TEST_CASE("A change of the scene uploads no brick that is resident", "[render][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const Volume head = headVolume();
  VolumeView view(*context, head, headScene());
  const RenderStats first = view.render().stats;
  CHECK(first.uploadedBricks == first.brickSlots);
  CHECK(first.uploadedBricks > 50);
  Renderer& renderer = view.renderer();

  // Less is visible: nothing is uploaded, and less is drawn.
  renderer.setTransfer(bone());
  const RenderStats less = view.render().stats;
  CHECK(less.uploadedBricks == 0);
  CHECK(less.visibleBricks < first.visibleBricks);
  CHECK(less.visibleBricks > 0);

  // What changes the picture and not the bricks.
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"camera",
       [&] {
         Camera camera = renderer.scene().camera;
         camera.eye += glm::dvec3(150, -80, 60);
         renderer.setCamera(camera);
       }},
      {"size",
       [&] {
         Camera camera = renderer.scene().camera;
         camera.width = 70;
         camera.height = 30;
         renderer.setCamera(camera);
       }},
      {"clip plane", [&] { renderer.setClip({ClipPlane(1, 0.2, 0, -110)}, {}); }},
      {"clip box",
       [&] {
         renderer.setClip({}, Box{{20, 30, 10}, {170, 180, 120}});
       }},
      {"model", [&] { renderer.setLight(Model::cone, Method::ordinates, {}); }},
      {"method", [&] { renderer.setLight(Model::cone, Method::dos, {}); }},
      {"theta",
       [&] {
         OcclusionOptions occlusion = renderer.scene().occlusion;
         occlusion.aperture = 0.5;
         renderer.setOcclusion(occlusion);
       }},
      {"bits",
       [&] {
         SamplingOptions sampling = renderer.scene().sampling;
         sampling.bits = 16;
         renderer.setSampling(sampling);
       }},
      {"thinner slabs",
       [&] {
         SamplingOptions sampling = renderer.scene().sampling;
         sampling.spacing *= 0.7;
         renderer.setSampling(sampling);
       }},
  };
  for (const auto& [what, change] : changes) {
    INFO(what);
    change();
    CHECK(view.render().stats.uploadedBricks == 0);
  }

  // Back to all: what was resident before still is.
  renderer.setTransfer(*headScene().transfer);
  CHECK(view.render().stats.uploadedBricks == 0);

  // From less to more, only what is new is uploaded.
  Scene boneScene = headScene();
  boneScene.transfer = bone();
  VolumeView other(*context, head, boneScene);
  const RenderStats few = other.render().stats;
  other.renderer().setTransfer(*headScene().transfer);
  const RenderStats all = other.render().stats;
  CHECK(all.brickSlots == first.brickSlots);
  CHECK(few.uploadedBricks + all.uploadedBricks == first.brickSlots);
}

TEST_CASE("Setters make the picture of a renderer that was made for the scene", "[render][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeSparse(glm::ivec3(0), 3, 6, 60), "balls");
  const Scene scene = sparseScene();
  const auto bricks = volume.cut(volume.resolve(scene));
  ResidentVolume resident(*context, *bricks, atlasOptions(volume.resolve(scene), *bricks));
  SliceRenderer renderer(resident, volume.resolve(scene), {.visibilityAndDepth = true});
  const auto same = [&](const std::string& what) {
    INFO(what);
    const Picture found = renderer.render();
    SliceRenderer fresh(*context, *bricks, renderer.scene(), {.visibilityAndDepth = true});
    const Picture expected = fresh.render();
    // Bricks may lie at other places of a texture, whose coordinates are rounded.
    CHECK(maxDifference(found.colour, expected.colour) < 2e-5);
    CHECK(maxDifference(found.visibility, expected.visibility) < 2e-5);
  };
  same("as made");
  TestRandom random(5);
  Camera camera = renderer.scene().camera;
  const double distance = glm::length(camera.eye - camera.lookAt);
  for (int i = 0; i < 12; ++i) {
    const std::string number = std::to_string(i);
    renderer.setTransfer(above(random.uniform(0.05, 0.6)));
    same("transfer " + number);
    camera.eye = camera.lookAt + distance * glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)));
    camera.up = {0.1, 0.2, 1};
    camera.width = 20 + random.below(40);
    renderer.setCamera(camera);
    same("camera " + number);
    renderer.setLight(i % 3 == 0 ? Model::emission : Model::cone, i % 2 ? Method::dos : Method::ordinates, {});
    same("light " + number);
    OcclusionOptions occlusion = renderer.scene().occlusion;
    occlusion.aperture = random.uniform(0, 1.4);
    occlusion.bits = i % 2 ? 32 : 16;
    occlusion.ordinates.directions = 1 + random.below(8);
    renderer.setOcclusion(occlusion);
    same("occlusion " + number);
    SamplingOptions sampling = renderer.scene().sampling;
    sampling.spacing = random.uniform(1, 2);
    sampling.quadrature = i % 4 == 1 ? Quadrature::midpoint : Quadrature::preintegrated;
    sampling.segments = 1 + random.below(4);
    renderer.setSampling(sampling);
    same("sampling " + number);
    renderer.setClip(i % 2 ? std::vector{ClipPlane(0, 1, 0.3, -random.uniform(0, 50))} : std::vector<ClipPlane>{},
                     i % 3 ? std::nullopt : std::optional(Box{{5, 5, 5}, {50, 55, 45}}));
    same("clip " + number);
  }
}

TEST_CASE("A visible background comes and goes with the transfer function", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeSparse(glm::ivec3(0), 3, 4, 50), "balls");
  VolumeView view(*context, volume, sparseScene());
  const Image before = view.render().colour;
  const glm::dvec3 albedo(1);
  view.renderer().setTransfer(TransferFunction({{0, {albedo, 0.01}}, {1, {albedo, 0.2}}}));
  const Picture fog = view.render();
  CHECK(fog.stats.visibleBricks > view.bricks().bricks.size());
  view.renderer().setTransfer(*sparseScene().transfer);
  const Picture after = view.render();
  CHECK(after.stats.uploadedBricks == 0);
  CHECK(maxDifference(before, after.colour) < 2e-5);
}

TEST_CASE("A scene that is refused leaves the one before", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeSparse(glm::ivec3(0), 3, 4, 50), "balls");
  VolumeView view(*context, volume, sparseScene());
  const Image before = view.render().colour;
  Renderer& renderer = view.renderer();
  const ResolvedScene scene = renderer.scene();
  CHECK_THROWS_WITH(renderer.setLight(Model::ambient, Method::ordinates, {}), Contains("ambient"));
  CHECK_THROWS_WITH(renderer.setLight(Model::lights, Method::dos, {}), Contains("dos"));
  Camera camera = scene.camera;
  camera.width = 1 << 20;
  CHECK_THROWS_WITH(renderer.setCamera(camera), Contains("size: 1048576 x 40"));
  renderer.setTransfer(scene.transfer.windowed(0, 0.5));
  renderer.setTransfer(scene.transfer);
  CHECK(renderer.scene() == scene);
  CHECK(maxDifference(view.render().colour, before) == 0);
  // Slabs of which the apron does not know.
  SamplingOptions thick = scene.sampling;
  thick.spacing = 40;
  renderer.setSampling(thick);
  CHECK_THROWS_WITH(view.render(), Contains("apron"));
  renderer.setSampling(scene.sampling);
  CHECK(maxDifference(view.render().colour, before) == 0);
}

TEST_CASE("Pixels of a scene that was saturated are not left out of the next one", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeDense({40, 40, 40}), "dense");
  Scene scene = sparseScene();
  scene.transfer = above(0.1).scaled(20);
  scene.model = Model::cone;
  scene.method = Method::dos;
  scene.sampling.saturation = 0.01;
  VolumeView view(*context, volume, scene);
  view.render();
  SamplingOptions sampling = view.renderer().scene().sampling;
  sampling.saturation = 0;
  sampling.spacing *= 0.6;  // more slices than before
  view.renderer().setSampling(sampling);
  Camera camera = view.renderer().scene().camera;
  camera.width = 64;
  view.renderer().setCamera(camera);
  const Image found = view.render().colour;
  VolumeView fresh(*context, volume, unresolved(view.renderer().scene()));
  CHECK(maxDifference(found, fresh.render().colour) < 2e-5);
}

TEST_CASE("A picture that could not be drawn cannot be read", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeSparse(glm::ivec3(0), 3, 4, 50), "balls");
  VolumeView view(*context, volume, sparseScene());
  view.render();
  SamplingOptions thick = view.renderer().scene().sampling;
  thick.spacing = 40;  // beyond the apron
  view.renderer().setSampling(thick);
  CHECK_THROWS_AS(view.renderer().draw(), InvalidArgument);
  CHECK_THROWS_WITH(view.renderer().read(), Contains("nothing was drawn"));
}

TEST_CASE("Bricks beyond the budget make room for each other, and the picture is the same", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  const Volume volume(makeDense({90, 90, 90}), "dense");
  Scene scene = sparseScene();
  scene.transfer = above(0.3);
  scene.bricks.interior = 16;
  const auto bricks = volume.cut(volume.resolve(scene));
  const ResolvedScene resolved = volume.resolve(scene);
  SliceRenderer whole(*context, *bricks, resolved);
  const Picture expected = whole.render();
  AtlasLimits limits;
  limits.budgetBytes = expected.stats.textureBytes * 2 / 3;
  SliceRenderer pooled(*context, *bricks, resolved, {}, limits);
  for (int picture = 0; picture < 3; ++picture) {
    const Picture found = pooled.render();
    CHECK(found.stats.textureBytes <= limits.budgetBytes * 11 / 10);  // slots are rounded up to a box of them
    CHECK(found.stats.uploadedBricks > 0);
    // Bricks lie at other places of the texture. Its coordinates are off by up to 6e-8 of an edge of 150 texels, 1e-5
    // voxels, which a slab of opacity 0.5 turns into as much of the colour; some 20 of them add up on a ray.
    CHECK(maxDifference(found.colour, expected.colour) < 2e-4);
  }
}

TEST_CASE("No camera needs more apron than the bricks of a volume have", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  TestRandom random(11);
  for (const glm::dmat4& toWorld : {glm::dmat4(1), crookedTransform()}) {
    const Volume volume(withTransform(makeSparse(glm::ivec3(0), 2, 3, 40), toWorld), "balls");
    Scene scene = sparseScene();
    scene.sampling.spacing = 3;
    scene.camera.fov = 1.2;
    scene.camera.width = 60;
    scene.camera.height = 20;
    VolumeView view(*context, volume, scene);
    Camera camera = view.renderer().scene().camera;
    const double distance = glm::length(camera.eye - camera.lookAt);
    for (int i = 0; i < 40; ++i) {
      camera.eye = camera.lookAt + distance * glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)));
      camera.up = random.point(glm::dvec3(-1), glm::dvec3(1));
      view.renderer().setCamera(camera);
      CHECK_NOTHROW(view.render());
    }
  }
}

TEST_CASE("One call renders what the parts render", "[render][gl]") {
  const auto context = testContext();
  if (!context) return;
  Scene scene;
  scene.volume.file = std::string(UMBRICK_ASSETS) + "/densityAndHeat.vdb";
  scene.volume.grid = "density";
  scene.transfer = loadTransferFunction("smoke");
  scene.camera.width = scene.camera.height = 32;
  const Image whole = renderScene(scene, {}, context.get()).colour;
  const Volume volume(scene.volume);
  CHECK(maxDifference(whole, VolumeView(*context, volume, scene).render().colour) == 0);
  scene.technique = Technique::shearWarp;
  CHECK_THROWS_WITH(renderScene(scene, {}, context.get()), "technique: shear-warp does not run on OpenGL");
  CHECK(maxDifference(renderScene(scene).colour, VolumeView(volume, scene).render().colour) == 0);
  scene.technique = Technique::slices;
  CHECK_THROWS_WITH(VolumeView(volume, scene), "technique: slices does not run on the CPU");
}

TEST_CASE("Techniques have names and say what they are", "[render]") {
  REQUIRE_FALSE(techniques().empty());
  for (const TechniqueTraits& traits : techniques()) {
    CHECK_FALSE(techniqueName(traits.technique).empty());
    CHECK_FALSE(traits.meaning.empty());
    CHECK((traits.makeOnGl != nullptr || traits.makeOnCpu != nullptr));
  }
}
