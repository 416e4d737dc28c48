// What annotations say of a scene, against the projection of the camera.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/annotations.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "support/test_scenes.h"

using namespace umbrick;

namespace {

// Returns where a point of the world is seen, pixels from the middle of the picture.
glm::dvec2 pixelOf(const Camera& camera, const glm::dvec3& point) {
  const CameraFrame frame = cameraFrame(camera);
  const glm::dvec3 to = point - camera.eye;
  glm::dvec2 across(glm::dot(to, frame.right), glm::dot(to, frame.up));
  if (camera.projection == Projection::perspective) across /= glm::dot(to, frame.forward);
  return across / screenPlane(camera).pixelSize;
}

std::vector<Camera> cameras() {
  std::vector<Camera> list{orthographicCamera({30, -22, 40}, {12, 11, 12}, 30, 300),
                           perspectiveCamera({30, -22, 40}, {12, 11, 12}, 0.6, 300),
                           perspectiveCamera({0.004, 0.001, -0.003}, {0, 0, 0}, 1.2, 64)};
  list[0].width = 700;
  return list;
}

ResolvedScene sceneOf(const TransferFunction& transfer) { return plainScene(transfer, cameras()[0], 1); }

}  // namespace

TEST_CASE("The triad's ends are the camera's projection of the axes", "[scene]") {
  for (const Camera& camera : cameras()) {
    const std::vector<TriadAxis> axes = worldTriad(camera);
    REQUIRE(axes.size() == 3);
    // Under perspective, a step that is short against the distance is seen as a parallel view sees it.
    const double step = 1e-6 * glm::length(camera.lookAt - camera.eye), perUnit = pixelsPerUnit(camera);
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 axis(0);
      axis[i] = 1;
      const glm::dvec2 seen = pixelOf(camera, camera.lookAt + step * axis) / (step * perUnit);
      const TriadAxis& drawn = axes[static_cast<std::size_t>(i)];
      CHECK(drawn.end.x == Approx(seen.x).margin(1e-5));
      CHECK(drawn.end.y == Approx(seen.y).margin(1e-5));
      CHECK(drawn.depth == Approx(glm::dot(axis, cameraFrame(camera).forward)));
      CHECK(drawn.label == std::string(1, static_cast<char>('x' + i)));
    }
  }
}

TEST_CASE("The scale bar has the projected length that it names", "[scene]") {
  for (const Camera& camera : cameras()) {
    const ScaleBar bar = scaleBar(camera, "mm");
    const double length = std::stod(bar.label);
    INFO(bar.label << ", " << bar.pixels << " pixels");
    const glm::dvec3 right = cameraFrame(camera).right;
    const double seen = glm::length(pixelOf(camera, camera.lookAt + 0.5 * length * right) -
                                    pixelOf(camera, camera.lookAt - 0.5 * length * right));
    CHECK(bar.pixels == Approx(seen).epsilon(1e-9));
    // At most a quarter of the picture's width, and more than a tenth: the next rounder length is 2.5 times as long.
    CHECK(bar.pixels <= 0.25 * camera.width * (1 + 1e-9));
    CHECK(bar.pixels > 0.0999 * camera.width);
    CHECK((bar.label.find("mm at the centre") != std::string::npos) == (camera.projection == Projection::perspective));
  }
  CHECK(scaleBar(cameras()[0], "").label.find(" units") != std::string::npos);
}

TEST_CASE("Lengths are 1, 2 or 5 times a power of ten", "[scene]") {
  CHECK(roundLength(1) == 1);
  CHECK(roundLength(1.99) == 1);
  CHECK(roundLength(2) == 2);
  CHECK(roundLength(4.99) == 2);
  CHECK(roundLength(5) == 5);
  CHECK(roundLength(9.99) == 5);
  CHECK(roundLength(10) == 10);
  CHECK(roundLength(0.003) == Approx(0.002));
  CHECK(roundLength(7e-9) == Approx(5e-9));
  CHECK(roundLength(2.5e12) == Approx(2e12));
  for (double longest = 1e-8; longest < 1e8; longest *= 1.37) {
    CHECK(roundLength(longest) <= longest * (1 + 1e-9));
    CHECK(roundLength(longest) > longest / 2.5001);
  }
}

TEST_CASE("The colour bar goes through the transfer function from end to end", "[scene]") {
  ResolvedScene scene = sceneOf(TransferFunction({{-1000, {{1, 0, 0}, 0}}, {3000, {{0, 1, 0.5}, 4}}}));
  scene.ambient = {0.5, 1, 1};
  const ColourBar bar = colourBar(scene, "HU", {});
  CHECK(bar.low == "-1000 HU");
  CHECK(bar.high == "3000 HU");
  REQUIRE(bar.colours.size() == bar.opacities.size());
  for (std::size_t i = 0; i < bar.colours.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(bar.colours.size());
    CHECK(bar.colours[i].r == Approx(0.5 * (1 - share)));
    CHECK(bar.colours[i].g == Approx(share));
    CHECK(bar.opacities[i] == Approx(share).epsilon(0.01).margin(1e-12));
  }
  CHECK(bar.opacities.back() == 1);
  // Colours are those that the picture has under the same exposure.
  CHECK(colourBar(scene, "", {.exposure = -1}).colours[100].g == Approx(0.5 * bar.colours[100].g));
  CHECK(colourBar(scene, "", {}).low == "-1000");
}

TEST_CASE("A step, a constant, nothing and two dimensions have a colour bar, too", "[scene]") {
  const Medium red{{1, 0, 0}, 1}, blue{{0, 0, 1}, 3}, none{{0, 0, 0}, 0};
  const ColourBar step = colourBar(sceneOf(TransferFunction({{5, red}, {5, blue}})), "", {});
  CHECK(step.low == "5");
  CHECK(step.high.empty());
  CHECK(step.colours.front() == glm::dvec3(1, 0, 0));
  CHECK(step.colours.back() == glm::dvec3(0, 0, 1));
  CHECK(step.opacities.front() == Approx(1.0 / 3));
  const ColourBar clear = colourBar(sceneOf(TransferFunction({{0, none}, {1, none}})), "", {});
  for (const double opacity : clear.opacities) CHECK(opacity == 0);
  // At each value it is the densest medium that counts, here that of the larger gradient.
  const ColourBar flat = colourBar(sceneOf(TransferFunction({0, 1}, {0, 10}, {red, red, blue, blue})), "", {});
  for (const glm::dvec3& colour : flat.colours) CHECK(colour == glm::dvec3(0, 0, 1));
}

TEST_CASE("Only annotations that are asked for are there", "[scene]") {
  const ResolvedScene scene = sceneOf(homogeneous({1, 1, 1}, 1));
  CHECK(annotationsOf(scene, {}, {}, {}).empty());
  const Annotations two = annotationsOf(scene, {Annotation::scale, Annotation::colours}, {"mm", "HU", ""}, {});
  CHECK(two.triad.empty());
  CHECK(two.scale);
  CHECK(two.colours);
  CHECK(annotationsOf(scene, {Annotation::triad}, {}, {}).triad.size() == 3);
}

TEST_CASE("The triad of a patient has the letters of its sides", "[scene]") {
  const std::vector<TriadAxis> axes = worldTriad(Camera{}, "LPS");
  REQUIRE(axes.size() == 3);
  CHECK(axes[0].label + axes[1].label + axes[2].label == "LPS");
  // What is no space of a patient has the names of the axes.
  CHECK(worldTriad(Camera{}, "LPX")[0].label == "x");
  CHECK(worldTriad(Camera{}, "scanner-xyz")[2].label == "z");
}
