// What a scene or a volume cannot do is reported in one line.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "shade/shade_fixture.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

TransferFunction unitRamp() { return TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), 1}}}); }
Camera camera() { return perspectiveCamera({40, 30, 50}, {16, 16, 16}, 0.7, 24); }

}  // namespace

TEST_CASE("Scenes that cannot be rendered are refused with the reason", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene scene = plainScene(unitRamp(), camera(), 1);
  const FieldBricks volume = fieldFor(
      scene, [](const glm::ivec3& i) { return i.x / 31.0; }, kBlock);
  const auto complaintOf = [&](const ResolvedScene& bad) {
    return complaint<InvalidArgument>([&] { renderPicture(*context, volume, bad); });
  };
  ResolvedScene bad = scene;
  bad.camera.width = context->maxTextureEdge2d() + 1;
  CHECK_THAT(complaintOf(bad), Contains("size") && Contains(std::to_string(context->maxTextureEdge2d())));
  bad = scene;
  bad.model = Model::coneRay;
  CHECK_THAT(complaintOf(bad), Contains("cone-ray") && Contains("reference"));
  bad = scene;
  bad.model = Model::ambient;
  bad.method = Method::ordinates;
  CHECK_THAT(complaintOf(bad), Contains("ordinates knows light from the viewer's side; ambient needs a light volume"));
  bad = scene;
  bad.bricks.format = "unorm12";
  CHECK_THAT(complaintOf(bad), Contains("unorm12") && Contains("unorm16"));
  bad = scene;
  bad.sampling.spacing = 5;
  CHECK_THAT(complaintOf(bad), Contains("apron of 2 voxels"));
  bad = scene;
  bad.transfer = TransferFunction({0, 1}, {0, 1}, std::vector<Medium>(4, {glm::dvec3(1), 1}));
  CHECK_THAT(complaintOf(bad), Contains("gradients"));
  // Planes share the uniforms of a shader with the transfer function: a linker would be the next to say so.
  bad = scene;
  bad.clipPlanes.assign(100000, ClipPlane(1, 0, 0, 1000));
  CHECK_THAT(complaintOf(bad), Contains("clip.planes: 100000 planes in all are beyond the driver's limit of "));
}

TEST_CASE("A budget that one slice does not fit is refused with both sizes", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = plainScene(unitRamp(), orthographicCamera({64, 64, 190}, {64, 64, 0}, 128, 24), 1);
  scene.bricks.budgetMiB = 1;  // of bricks of 20^3 * 4 bytes it holds 32
  const FieldBricks volume =
      fieldFor(scene, [](const glm::ivec3& i) { return (i.x + i.y + i.z) / 400.0; }, {glm::ivec3(0), glm::ivec3(127)});
  CHECK_THAT(complaint<InvalidArgument>([&] { renderPicture(*context, volume, scene); }),
             Contains("one slice") && Contains(" MiB"));
  scene.bricks.interior = 64;
  const FieldBricks large =
      fieldFor(scene, [](const glm::ivec3& i) { return i.x / 400.0; }, {glm::ivec3(0), glm::ivec3(63)});
  CHECK_THAT(complaint<InvalidArgument>([&] { renderPicture(*context, large, scene); }),
             Contains("1.1 MiB") && Contains(" 1 MiB"));
}

TEST_CASE("A renderer takes other cameras, of other image sizes too", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = plainScene(unitRamp(), camera(), 1);
  scene.model = Model::cone;
  const FieldBricks volume = fieldFor(
      scene, [](const glm::ivec3& i) { return std::sin(0.3 * i.x) * std::sin(0.2 * i.y); }, kBlock);
  SliceRenderer renderer(*context, volume, scene);
  renderer.render();
  // Of either projection; nothing of an earlier picture stays.
  for (const Camera& next : {perspectiveCamera({-30, 20, 40}, {16, 16, 16}, 0.5, 24),
                             orthographicCamera({-30, 20, 40}, {16, 16, 16}, 30, 31)}) {
    ResolvedScene same = scene;
    same.camera = next;
    CHECK(maxDifference(renderer.render(next).colour, renderPicture(*context, volume, same).colour) == 0);
  }
  Camera wide = camera();
  wide.fov = 2.9;  // the slabs at its corners reach far
  CHECK_THAT(complaint<InvalidArgument>([&] { renderer.render(wide); }), Contains("apron"));
}

TEST_CASE("There is no slice to probe before a picture or beyond it", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene scene = plainScene(unitRamp(), camera(), 1);
  const FieldBricks volume = fieldFor(
      scene, [](const glm::ivec3& i) { return i.x / 31.0; }, kBlock);
  SliceRenderer renderer(*context, volume, scene);
  CHECK(renderer.sliceDepths().empty());
  CHECK_THAT(complaint<InvalidArgument>([&] { renderer.probe(0); }), Contains("no slice 0"));
  const Picture picture = renderer.render();
  CHECK(renderer.sliceDepths().size() == static_cast<std::size_t>(picture.stats.slices));
  CHECK_THAT(complaint<InvalidArgument>([&] { renderer.probe(picture.stats.slices); }), Contains("no slice"));
  CHECK_THAT(complaint<InvalidArgument>([&] { renderer.probe(-1); }), Contains("no slice -1"));
}

TEST_CASE("An empty volume gives an empty picture", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Model model : {Model::emission, Model::cone}) {
    ResolvedScene scene = plainScene(unitRamp(), camera(), 1);
    scene.model = model;
    scene.sampling.saturation = 1e-3;
    const FieldBricks empty = fieldFor(
        scene, [](const glm::ivec3&) { return 0.0; }, IndexBox{});
    REQUIRE(empty.bricks.empty());
    const Picture picture = renderPicture(*context, empty, scene, {.visibilityAndDepth = true});
    CHECK(picture.stats.slices == 0);
    CHECK(picture.stats.fragments == 0);
    CHECK(maxDifference(picture.colour, Image(24, 24)) == 0);
    // The background would be visible, but there is no place where it could be seen.
    scene.transfer = homogeneous(glm::dvec3(1), 1);
    CHECK(maxDifference(renderPicture(*context, empty, scene).colour, Image(24, 24)) == 0);
    scene.background = glm::dvec3(0.5);
    CHECK(renderPicture(*context, empty, scene).colour.at(3, 3)[2] == 0.5f);
  }
}

TEST_CASE("Resolving a scene writes out what the volume decides", "[shade]") {
  const Box bounds{glm::dvec3(0), glm::dvec3(20, 30, 40)};
  const glm::dmat4 anisotropic(2, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1);
  Scene scene;
  CHECK_THAT(complaint<InvalidArgument>([&] { resolveScene(scene, bounds, anisotropic); }),
             Contains("no transfer function"));
  scene.transfer = unitRamp();
  const ResolvedScene resolved = resolveScene(scene, bounds, anisotropic);
  CHECK(resolved.sampling.spacing == 0.25);  // half of a voxel's shortest edge
  CHECK(glm::distance(resolved.camera.lookAt, bounds.centre()) < 1e-12);
  CHECK(resolveScene(unresolved(resolved), {}, glm::dmat4(7)) == resolved);
  CHECK(parseScene(printScene(resolved), "printed") == unresolved(resolved));
  CHECK_THAT(complaint<InvalidArgument>([&] { resolveScene(scene, {}, anisotropic); }), Contains("empty"));
  scene.sampling.spacing = -1;
  CHECK_THAT(complaint<InvalidArgument>([&] { resolveScene(scene, bounds, anisotropic); }), Contains("spacing"));
}

// A slab reads half its length beyond a brick along each axis, and every sample reads half a voxel beyond.
TEST_CASE("The apron follows from the reach of a slab", "[shade]") {
  ResolvedScene scene = plainScene(unitRamp(), orthographicCamera({0, 0, 9}, {0, 0, 0}, 1, 8), 1);
  scene.camera.up = {0, 1, 0};
  CHECK(requiredApron(scene, glm::dmat4(1)) == 1);
  scene.sampling.spacing = 1.5;
  CHECK(requiredApron(scene, glm::dmat4(1)) == 2);
  scene.sampling.spacing = 7;
  CHECK(requiredApron(scene, glm::dmat4(1)) == 4);
  // Segments, and slabs that planes cut, have middles anywhere in a slab.
  scene.sampling.quadrature = Quadrature::midpoint;
  CHECK(requiredApron(scene, glm::dmat4(1)) == 4);
  scene.sampling.quadrature = Quadrature::preintegrated;
  // At the corner of a wide view a ray is 1 + 2 tan^2 times as long, but farther along an axis only if it leans.
  scene.camera = perspectiveCamera({0, 0, 9}, {0, 0, 0}, 2 * std::atan(3.0), 8);
  scene.camera.up = {0, 1, 0};
  CHECK(requiredApron(scene, glm::dmat4(1)) == 11);  // 3.5 * 3 + 0.5
  scene.sampling.spacing = 100;
  CHECK_THAT(complaint<InvalidArgument>([&] { requiredApron(scene, glm::dmat4(1)); }),
             Contains("151") && Contains("16"));
  scene.bricks.interior = 0;
  CHECK(requiredApron(scene, glm::dmat4(1)) == 151);
}

TEST_CASE("Bricks are as large as pixels and aprons ask for, unless the scene says how large", "[shade]") {
  // The picture shows 2 x 2 world units on 8 x 8 pixels; voxels have an edge of 1.
  ResolvedScene scene = plainScene(unitRamp(), orthographicCamera({0, 0, 9}, {0, 0, 0}, 2, 8), 1);
  const Box bounds{{-1, -1, -1}, {1, 1, 1}};
  const glm::dmat4 voxels(1);
  CHECK(brickInterior(scene, voxels, bounds) == 16);
  scene.bricks.interior = 0;
  CHECK(brickInterior(scene, voxels, bounds) == 24);
  scene.camera.viewHeight = 40;  // 5 voxels to a pixel
  CHECK(brickInterior(scene, voxels, bounds) == 40);
  scene.camera.viewHeight = 4000;
  CHECK(brickInterior(scene, voxels, bounds) == 48);
  scene.sampling.spacing = 41;  // an apron of 21
  CHECK(brickInterior(scene, voxels, bounds) == 64);
  scene.sampling.spacing = 400;
  CHECK(brickInterior(scene, voxels, bounds) == 256);
  scene.sampling.spacing = 1;
  // This is seen by an eye at a distance of 9; within the bounds pixels are small.
  scene.camera = perspectiveCamera({0, 0, 9}, {0, 0, 0}, 2 * std::atan(20.0 / 9), 8);
  CHECK(brickInterior(scene, voxels, bounds) == 40);
  scene.camera = perspectiveCamera({0, 0, 0}, {0, 0, -1}, 2 * std::atan(20.0 / 9), 8);
  CHECK(brickInterior(scene, voxels, bounds) == 24);
}
