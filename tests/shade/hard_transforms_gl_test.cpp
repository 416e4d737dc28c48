// Hard cases of where a volume is and how it lies: index to world, cameras along its planes. Tested elsewhere: chords
// through rotated, anisotropic, sheared and mirrored boxes (emission_gl_test); that bricks change nothing in such
// volumes, on faces and voxel planes, and 1e6 voxels from the origin (check).
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "shade/hard_case.h"

using namespace umbrick;

namespace {

ResolvedScene blobScene(Model model, const Camera& camera) {
  ResolvedScene scene = plainScene(ramp(0.6), camera, 0.5);
  scene.model = model;
  scene.sampling.saturation = SamplingOptions().saturation;
  return scene;
}

// Returns the scene with all its lengths `scale` times as long.
ResolvedScene scaled(ResolvedScene scene, double scale) {
  scene.camera.eye *= scale;
  scene.camera.lookAt *= scale;
  scene.camera.viewHeight *= scale;
  scene.camera.nearDistance *= scale;
  scene.sampling.spacing *= scale;
  scene.transfer = scene.transfer.scaled(1 / scale);
  for (ClipPlane& plane : scene.clipPlanes) plane.w *= scale;
  return scene;
}

}  // namespace

// These are bricks of a field, since OpenVDB takes no voxels below 1.5e-5 units. A scale by a power of two moves no
// digit. Other scales round coordinates, by 6e-8 of an atlas of some 40 texels, where values differ by up to a quarter
// from texel to texel and optical depths by 0.15, on each of some 50 slabs: at worst 50 * 0.15 * 2.4e-6.
TEST_CASE("Huge and tiny worlds look like one of unit size", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Model model : {Model::emission, Model::cone})
    for (const Camera& camera : smallCameras()) {
      ResolvedScene scene = blobScene(model, camera);
      scene.camera.nearDistance = 5;
      scene.clipPlanes = {{0.3, -0.5, -0.8, 16}};
      const IndexBox voxels{glm::ivec3(0), glm::ivec3(23)};
      const Picture unit = renderPicture(*context, fieldFor(scene, smallBlobs, voxels), scene, kLayers);
      REQUIRE(largestAlpha(unit.colour) > 0.9);
      for (const double scale : {0x1p-20, 1e-6, 1e6, 0x1p40, 1e-12}) {
        INFO("scale " << scale << ", cone " << (model == Model::cone) << ", perspective "
                      << (camera.projection == Projection::perspective));
        const ResolvedScene other = scaled(scene, scale);
        FieldOptions options;
        options.indexToWorld = glm::scale(glm::dmat4(1), glm::dvec3(scale));
        const Picture picture = renderPicture(*context, fieldFor(other, smallBlobs, voxels, options), other, kLayers);
        CHECK(maxDifference(picture.colour, unit.colour) < 2e-5);
        CHECK(maxDifference(picture.visibility, unit.visibility) < 2e-5);
        double depth = 0;
        for (std::size_t i = 0; i < unit.depth.pixels.size(); ++i)
          if (std::isfinite(unit.depth.pixels[i]))
            depth = std::max(depth, std::abs(picture.depth.pixels[i] / scale - unit.depth.pixels[i]));
        CHECK(depth < 2e-3);  // where opacity is 1e-2, a change of 2e-5 is as much of the range of some 20 units
      }
    }
}

TEST_CASE("Grids of the smallest voxels that OpenVDB takes and of huge ones match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid unit = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  for (const double scale : {1.6e-5, 1e6}) {
    INFO("scale " << scale);
    const ScalarGrid grid = withTransform(unit, glm::scale(glm::dmat4(1), glm::dvec3(scale)));
    checkViewsAgainstReference(*context, grid, ramp(0.6 / scale), grid.worldBounds(), 0.5 * scale);
  }
}

// The apron and the slabs' reach follow from the axes, so that each of these grids needs other ones.
TEST_CASE("Rotated, anisotropic, sheared and mirrored grids match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled({24, 24, 24}, {0, 0, 0}, smallBlobs);
  const std::pair<std::string, glm::dmat4> transforms[] = {
      {"rotated", glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 2, -1)))},
      {"anisotropic", glm::scale(glm::dmat4(1), glm::dvec3(0.25, 3, 1))},
      {"sheared", glm::dmat4(1, 0, 0, 0, 0.7, 1, 0, 0, -0.4, 0.9, 1, 0, 0, 0, 0, 1)},
      {"mirrored", glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1))},
      {"all of it, and moved", crookedTransform()}};
  for (const auto& [name, transform] : transforms) {
    INFO(name);
    const ScalarGrid placed = withTransform(grid, transform);
    checkViewsAgainstReference(*context, placed, ramp(0.5), placed.worldBounds(),
                               0.5 * shortestVoxelEdge(transform) * (name == "anisotropic" ? 2 : 1));
  }
}

// A mirror image seen by a mirrored camera is the mirrored picture.
TEST_CASE("A mirrored world is the mirror image", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const Model model : {Model::emission, Model::cone})
    for (const Camera& camera : smallCameras()) {
      ResolvedScene scene = blobScene(model, camera);
      scene.camera.up = {0, 1, 0};
      const IndexBox voxels{glm::ivec3(0), glm::ivec3(23)};
      const Image plain = renderPicture(*context, fieldFor(scene, smallBlobs, voxels), scene).colour;
      for (glm::dvec3* point : {&scene.camera.eye, &scene.camera.lookAt}) point->x *= -1;
      FieldOptions options;
      options.indexToWorld = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
      const Image mirrored = renderPicture(*context, fieldFor(scene, smallBlobs, voxels, options), scene).colour;
      Image back = mirrored;
      for (int y = 0; y < back.height; ++y)
        for (int x = 0; x < back.width; ++x) std::copy_n(mirrored.at(mirrored.width - 1 - x, y), 4, back.at(x, y));
      CHECK(maxDifference(plain, back) < 2e-5);  // roundings as above
    }
}

// Double precision has steps of 1e-10 there, single precision of 0.06 voxels, so no coordinate may be rounded to it.
TEST_CASE("A grid 1e6 voxels from the origin looks like one at the origin", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::ivec3 far(1'000'000, -1'000'000, 1'000'000);  // a multiple of the bricks' edge
  const IndexBox voxels{glm::ivec3(0), glm::ivec3(23)};
  for (const glm::dmat4& transform : {glm::dmat4(1), crookedTransform()})
    for (const Model model : {Model::emission, Model::cone})
      for (Camera camera : smallCameras()) {
        INFO("crooked " << (transform != glm::dmat4(1)) << ", cone " << (model == Model::cone));
        FieldOptions options;
        options.indexToWorld = transform;
        const glm::dvec3 centre(transform * glm::dvec4(kSmallCentre, 1));
        camera.eye += centre - camera.lookAt;
        camera.lookAt = centre;
        ResolvedScene scene = blobScene(model, camera);
        scene.clipPlanes = {{0.3, -0.5, -0.8, 4 - glm::dot(glm::dvec3(0.3, -0.5, -0.8), centre)}};
        const Picture here = renderPicture(*context, fieldFor(scene, smallBlobs, voxels, options), scene, kLayers);
        const glm::dvec3 moved = glm::dmat3(transform) * glm::dvec3(far);
        scene.camera.eye += moved;
        scene.camera.lookAt += moved;
        scene.clipPlanes[0].w -= glm::dot(glm::dvec3(scene.clipPlanes[0]), moved);
        const auto farBlobs = [&](const glm::ivec3& i) { return smallBlobs(i - far); };
        const FieldBricks there = fieldFor(scene, farBlobs, {voxels.min + far, voxels.max + far}, options);
        const Picture picture = renderPicture(*context, there, scene, kLayers);
        REQUIRE(largestAlpha(here.colour) > 0.5);
        // 1e-9 units of displacement change nothing in single precision, but a vertex in a million may snap elsewhere.
        CHECK(maxDifference(here.colour, picture.colour) < 2e-5);
        CHECK(maxDifference(here.visibility, picture.visibility) < 2e-5);
      }
  // The picture is also compared with the reference, which computes in double precision throughout.
  const ScalarGrid grid = makeFilled({24, 24, 24}, far, smallBlobs);
  checkViewsAgainstReference(*context, grid, ramp(0.6), {glm::dvec3(far), glm::dvec3(far + 23)}, 0.5);
}

// The volume is noise: each plane of voxels differs from the next as much as possible. Slices go through the planes or
// half-way between them. Rays go along the planes, too, at centres of voxels and at faces between bricks.
TEST_CASE("Views along planes of the grid and slices on planes of voxels match the reference", "[shade][gl][slow]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeNoise({20, 20, 20}, {0, 0, 0});
  for (const double phase : {0.0, 0.25})   // of the slices' middles, in voxels
    for (const double aside : {0.0, 0.5})  // pixels' centres lie on voxel centres, or on faces
      for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1)})
        for (const Model model : {Model::emission, Model::cone}) {
          INFO("phase " << phase << ", aside " << aside << ", axis " << axis.x << ' ' << axis.y << ' ' << axis.z
                        << ", cone " << (model == Model::cone));
          // Slices with a spacing of 0.5 have their middles at quarters from the eye.
          const glm::dvec3 middle(7.5 + aside);  // pixels are a voxel wide, 16 to a row
          Camera camera = orthographicCamera(middle + axis * (22.25 + phase), middle, 16, 16);
          camera.up = {axis.z, axis.x, -axis.y};
          ResolvedScene scene = plainScene(ramp(0.3), camera, 0.5);
          scene.model = model;
          scene.occlusion.aperture = 0;
          // On planes of voxels the value is piecewise linear along a ray, and slabs of half a voxel that end there are
          // exact: then only the table is left to change anything, and the order of the error cannot be seen.
          checkAgainstReference(*context, grid, scene, 5e-5);
        }
  // A perspective view looks straight at a face, with the eye in the plane of another one.
  ResolvedScene scene = plainScene(ramp(0.3), perspectiveCamera({-0.5, 7.5, 50}, {-0.5, 7.5, 0}, 0.7, 32), 0.5);
  scene.camera.up = {0, 1, 0};
  checkAgainstReference(*context, grid, scene);
}
