// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "support/random_transfer.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

Scene parse(const std::string& text) { return parseScene(text, "s.json"); }

// Returns a valid scene in which every field differs from its default.
Scene randomScene(std::mt19937& random) {
  std::mt19937_64 wide(random());
  const auto number = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(wide); };
  const auto vector = [&](double low, double high) {
    const double x = number(low, high), y = number(low, high);
    return glm::dvec3(x, y, number(low, high));
  };
  Scene scene;
  scene.volume = {"some folder/vol\"1.vdb", "density[1]"};
  scene.volume.series = "1.2.840.\"3";
  scene.volume.where = {"AcquisitionNumber=2", "0018,0081=4.6"};
  scene.transfer = random() % 2 ? randomTransferFunction(random, 5) : randomTransferFunction2d(random, 3);
  scene.camera.projection = Projection::orthographic;
  scene.camera.fov = number(0.01, 3.1);
  scene.camera.nearDistance = number(0, 9);
  scene.camera.width = 1 + static_cast<int>(random() % 2000);
  scene.camera.height = 1 + static_cast<int>(random() % 2000);
  if (random() % 2) {
    scene.orbit = Orbit{number(-7, 7), number(-2, 2)};
  } else {
    scene.orbit.reset();
    scene.camera.eye = vector(-1e5, 1e5);
    scene.camera.lookAt = vector(-1, 1);
    scene.camera.up = vector(-1e-5, 1e-5);
    scene.camera.viewHeight = number(1e-6, 1e6);
  }
  scene.model = Model::cone;
  scene.ambient = vector(0, 5);
  scene.background = vector(0, 1);
  scene.lights = {{LightFrame::view, ConeLight{{number(-0.1, 0.1), 0.05, 1}, number(0, 1.3), vector(0, 7)}},
                  {LightFrame::world, ConeLight{vector(-1, 1), number(0, 1.5), vector(0, 1)}},
                  {LightFrame::world, ListedLight{{{vector(-1, 1), number(0, 1), vector(0, 1)}, {vector(-1, 1)}}}}};
  scene.mode = Mode::isosurface;
  scene.surfaces = {{number(-9, 9), vector(0, 1), number(0, 1)}, {number(-1e9, 1e9), {}, 1}};
  scene.shading = {Shading::phong, ShadingLight::headlight, number(0, 1), number(0, 1), number(0, 1), number(1, 99)};
  scene.sampling = {.spacing = number(1e-4, 5),
                    .quadrature = Quadrature::midpoint,
                    .classification = Classification::pre,
                    .segments = 5,
                    .bits = 16,
                    .saturation = number(0, 0.1)};
  scene.spacingUnit = SpacingUnit::world;
  const double gradient = number(0, 9);
  scene.gradientOpacity = {gradient, gradient + number(0.1, 9)};
  scene.gradientUnit = GradientUnit::percent;
  scene.gradients = GradientFilter::bspline;
  scene.occlusion = {number(0, 1.57), 16, {5, 2, 2, false}, {7, number(0, 4)}};
  scene.clipPlanes = {ClipPlane(vector(-1, 1), number(-9, 9)), ClipPlane(vector(-1, 1), number(-9, 9))};
  scene.clipBox = Box{vector(-9, -1), vector(0, 9)};
  scene.bricks = {false, 64, false, "half", 123'456'789'012};
  return scene;
}

}  // namespace

TEST_CASE("A printed scene parses back to an equal one, to the last bit", "[scene]") {
  std::mt19937 random(31);
  for (int i = 0; i < 200; ++i) {
    const Scene scene = randomScene(random);
    validateScene(scene);
    const Scene again = parse(printScene(scene));
    REQUIRE(again == scene);
  }
  CHECK(parse(printScene(Scene{})) == Scene{});
}

TEST_CASE("What a scene leaves out keeps its default", "[scene]") {
  CHECK(parse("{}") == Scene{});
  const Scene scene = parse(R"({"camera": {"azimuth": 90}, "occlusion": {"theta": 45}})");
  CHECK(scene.orbit->azimuth == Approx(std::numbers::pi / 2).epsilon(1e-15));
  CHECK(scene.orbit->elevation == 0);
  CHECK(scene.occlusion.aperture == Approx(std::numbers::pi / 4).epsilon(1e-15));
  CHECK(scene.occlusion.dos == DosOptions{});
  CHECK_FALSE(scene.background);
}

TEST_CASE("An eye replaces the orbit", "[scene]") {
  const Scene scene = parse(R"({"camera": {"eye": [1, 2, 3], "up": [0, 0, 1], "viewHeight": 7,
                                           "projection": "orthographic"}})");
  CHECK_FALSE(scene.orbit);
  CHECK(scene.camera.eye == glm::dvec3(1, 2, 3));
  CHECK(scene.camera.viewHeight == 7);
  CHECK_THROWS_WITH(parse(R"({"camera": {"eye": [1, 2, 3], "azimuth": 7}})"),
                    "s.json:1:42: camera.azimuth: places the camera, but so does 'eye': give one of them");
  CHECK_THROWS_WITH(parse(R"({"camera": {"up": [1, 2, 3]}})"), Contains("camera.up: needs 'eye'"));
}

TEST_CASE("A transfer function comes from a preset, a file or the scene itself", "[scene]") {
  const TemporaryFolder folder;
  const std::string inlined = R"({"points": [{"value": 1, "albedo": [1, 1, 1], "sigma_t": 2}]})";
  std::ofstream(folder.path() / "mine.json") << inlined;
  std::ofstream(folder.path() / "bad.json") << "{\"points\":\n 7}";
  const auto read = [&](const std::string& text) {
    std::ofstream(folder.path() / "scene.json") << text;
    return readScene(folder.path() / "scene.json");
  };
  CHECK(read(R"({"transfer": "ct-head"})").transfer == loadTransferFunction("ct-head"));
  CHECK(read(R"({"transfer": "mine.json"})").transfer == parseTransferFunction(inlined, ""));
  CHECK(read("{\"transfer\": " + inlined + "}").transfer == parseTransferFunction(inlined, ""));
  CHECK(read(R"({"transfer": [{"RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1], "ColorSpace": "RGB"}]})")
            .transfer->values()
            .back() == 1);
  CHECK(read(R"({"transfer": "smoke", "window": [1, 5], "sigmaScale": 2})").transfer ==
        loadTransferFunction("smoke").windowed(1, 5).scaled(2));
  CHECK(read(R"({"volume": {"file": "a.vdb"}})").volume.file == folder.path() / "a.vdb");
  CHECK(read(R"({"volume": {"file": "/a.vdb"}})").volume.file == "/a.vdb");
  CHECK_THROWS_WITH(read("{\n\"transfer\": \"smoek\"}"),
                    Contains("scene.json:2:13: transfer: expected a file or one of the presets cloud"));
  CHECK_THROWS_WITH(read(R"({"transfer": "bad.json"})"), Contains("bad.json:2:2: points: expected an array, found 7"));
  CHECK_THROWS_WITH(read(R"({"transfer": {"points": [{"value": 0}]}})"),
                    Contains("scene.json:1:26: transfer.points[0]: the field 'albedo' is missing"));
  CHECK_THROWS_WITH(read(R"({"window": [0, 1]})"), Contains("window: there is no 'transfer'"));
}

TEST_CASE("Malformed scenes are refused with line, column and field", "[scene]") {
  CHECK_THROWS_WITH(parse("{\n  \"occlusion\": {\"theta\": 90}\n}"),
                    "s.json:2:26: occlusion.theta: is 90 degrees, must be in [0, 90)");
  CHECK_THROWS_WITH(parse(R"({"oclusion": {}})"), "s.json:1:14: oclusion: unknown field; did you mean 'occlusion'?");
  CHECK_THROWS_WITH(parse(R"({"occlusion": {"Theta": 3}})"), Contains("did you mean 'theta'?"));
  CHECK_THROWS_WITH(parse(R"({"camera": {"size": [512]}})"),
                    Contains("camera.size: expected an array of 2, found an array of 1"));
  CHECK_THROWS_WITH(parse(R"({"camera": {"size": [512, 3.5]}})"),
                    Contains("camera.size[1]: expected a whole number, found 3.5"));
  CHECK_THROWS_WITH(parse(R"({"camera": {"size": [512, 0]}})"),
                    Contains("camera.size: is 512 x 0, must be at least 1 x 1"));
  CHECK_THROWS_WITH(parse(R"({"camera": {"eye": [0, 0, 0]}})"), Contains("camera: eye and look-at are the same point"));
  CHECK_THROWS_WITH(parse(R"({"camera": {"projection": "fisheye"}})"),
                    Contains("camera.projection: expected one of perspective, orthographic, found 'fisheye'"));
  CHECK_THROWS_WITH(parse(R"({"model": 7})"), Contains("model: expected a string, found 7"));
  CHECK_THROWS_WITH(parse(R"({"sampling": {"spacing": 0}})"), Contains("sampling.spacing: is 0, must be above 0"));
  CHECK_THROWS_WITH(parse(R"({"clip": {"planes": [[0, 0, 1, 0], [0, 0, 0, 1]]}})"),
                    Contains("s.json:1:36: clip.planes[1]: is [0, 0, 0, 1], must be a plane"));
  CHECK_THROWS_WITH(parse(R"({"clip": {"box": [[0, 0, 0], [1, 0, 1]]}})"),
                    Contains("clip.box: is [0, 0, 0] to [1, 0, 1]"));
  CHECK_THROWS_WITH(parse(R"({"bricks": {"format": "rgb"}})"),
                    Contains("bricks.format: expected one of auto, unorm8, unorm16, half, float32, found 'rgb'"));
  CHECK_THROWS_WITH(parse(R"({"bricks": {"budgetMiB": -1}})"), Contains("bricks.budgetMiB: expected a whole number"));
  CHECK_THROWS_WITH(parse("[1, 2"), Contains("not JSON"));
  CHECK_THROWS_WITH(parse("[1, 2]"), Contains("s.json:1:1: expected an object, found an array of 2"));
  CHECK_THROWS_WITH(readScene("/nowhere/scene.json"), Contains("/nowhere/scene.json: cannot read: No such file"));
}

TEST_CASE("A light is read in each of its ways", "[scene]") {
  const auto lights = [](const std::string& sources) {
    return parse("{\"light\": {\"sources\": [" + sources + "]}}").lights;
  };
  const ConeLight cone{{1, 0, 2}, 20 * std::numbers::pi / 180, glm::dvec3(1)};
  CHECK(lights(R"({"type": "cone", "axis": [1, 0, 2], "theta": 20})")[0] == LightSource{LightFrame::view, cone});
  CHECK(lights(R"({"type": "directional", "direction": [1, 0, 2], "softAngle": 20, "frame": "world"})")[0] ==
        LightSource{LightFrame::world, cone});
  CHECK(lights(R"({"type": "directional", "direction": [1, 0, 2], "radiance": 3})")[0] ==
        LightSource{LightFrame::view, ConeLight{{1, 0, 2}, 0, glm::dvec3(3)}});
  CHECK(lights(R"({"type": "cone", "axis": [1, 0, 2], "theta": 1, "radiance": [3, 2, 1]})").size() == 1);
  CHECK(lights(R"({"type": "directions", "list": [{"direction": [1, 0, 2]}, {"direction": [0, 0, 1], "weight": 0.5,
                   "colour": [1, 0.5, 0]}]})")[0] ==
        LightSource{LightFrame::view, ListedLight{{{{1, 0, 2}, 1, glm::dvec3(1)}, {{0, 0, 1}, 0.5, {1, 0.5, 0}}}}});
  CHECK_THROWS_WITH(lights(R"({"axis": [0, 0, 1]})"), Contains("light.sources[0]: the field 'type' is missing"));
  CHECK_THROWS_WITH(
      lights(R"({"type": "lamp"})"),
      Contains("light.sources[0].type: expected one of cone, directional, directions") && Contains("found 'lamp'"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "frame": "eye"})"),
                    Contains("expected one of view, world, found 'eye'"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "axis": [0, 0, 1]})"), Contains("the field 'theta' is missing"));
  CHECK_THROWS_WITH(lights(R"({"type": "directional", "axis": [0, 0, 1]})"),
                    Contains("s.json:1:") && Contains("light.sources[0]: unknown field; known are"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "axis": [0, 0, 1], "theta": 20, "radiance": "red"})"),
                    Contains("light.sources[0].radiance: expected a number, found 'red'"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "axis": [0, 0, 1], "theta": 20, "radiance": [1, -2, 3]})"),
                    Contains("light.sources[0].radiance: is [1, -2, 3], must be three finite numbers of 0 or more"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "axis": [0, 0, 1], "theta": 90})"),
                    Contains("light.sources[0]: is a cone of half-angle 90 degrees, must be of one in [0, 90)"));
  CHECK_THROWS_WITH(lights(R"({"type": "cone", "axis": [0, 0, 0], "theta": 9})"),
                    Contains("light.sources[0]: is along the axis [0, 0, 0], must be along three finite numbers"));
  CHECK_THROWS_WITH(lights(R"({"type": "directions", "list": []})"), Contains("light.sources[0].list: is empty"));
  CHECK_THROWS_WITH(lights(R"({"type": "directions", "list": [{"direction": [0, 0, 1], "weight": -1}]})"),
                    Contains("light.sources[0].list[0].weight: is -1, must be 0 or more"));
  CHECK_THROWS_WITH(lights(R"({"type": "directional", "direction": [0, 1, -1]})"),
                    Contains("light.sources[0]: its axis is 135 degrees from the direction to the viewer"));
  CHECK_THROWS_WITH(parse(R"({"model": "lights", "light": {"ambient": [1, 1, 1]}})"),
                    Contains("light: is empty, must be one source or more for the model lights"));
}

TEST_CASE("Every field of a scene has its range, however the scene was made", "[scene]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  struct Case {
    const char* field;
    std::function<void(Scene&)> change;
  };
  const Case cases[] = {
      {"camera.size", [](Scene& s) { s.camera.width = 0; }},
      {"camera.fov", [](Scene& s) { s.camera.fov = 0; }},
      {"camera.fov", [](Scene& s) { s.camera.fov = std::numbers::pi; }},
      {"camera.near", [=](Scene& s) { s.camera.nearDistance = infinity; }},
      {"camera.near", [](Scene& s) { s.camera.nearDistance = -1; }},
      {"camera.azimuth", [=](Scene& s) { s.orbit->azimuth = nan; }},
      {"camera.elevation", [=](Scene& s) { s.orbit->elevation = nan; }},
      {"camera.eye", [=](Scene& s) { s.orbit.reset(), s.camera.eye.x = nan; }},
      {"camera.viewHeight", [](Scene& s) { s.orbit.reset(), s.camera.viewHeight = 0; }},
      {"camera: up is parallel",
       [](Scene& s) {
         s.orbit.reset(), s.camera.up = {0, 0, 2};
       }},
      {"light.ambient", [](Scene& s) { s.ambient.g = -0.1; }},
      {"light.background", [=](Scene& s) { s.background = glm::dvec3(infinity); }},
      {"light.sources: is empty", [](Scene& s) { s.model = Model::lights; }},
      {"light.sources[0]: is along",
       [=](Scene& s) {
         s.lights = {{LightFrame::world, ConeLight{{nan, 0, 1}, 0.1}}};
       }},
      {"light.sources[0]: is a cone",
       [](Scene& s) {
         s.lights = {{LightFrame::view, ConeLight{{0, 0, 1}, -0.1}}};
       }},
      {"light.sources[0].radiance",
       [](Scene& s) {
         s.lights = {{LightFrame::view, ConeLight{{0, 0, 1}, 0.1, {1, -1, 1}}}};
       }},
      {"light.sources[0].list",
       [](Scene& s) {
         s.lights = {{LightFrame::view, ListedLight{}}};
       }},
      {"light.sources[0].list[0].direction",
       [](Scene& s) {
         s.lights = {{LightFrame::view, ListedLight{{{{0, 0, 0}}}}}};
       }},
      {"light.sources[0].list[0].weight",
       [=](Scene& s) {
         s.lights = {{LightFrame::view, ListedLight{{{{0, 0, 1}, infinity}}}}};
       }},
      {"light.sources[0].list[0].colour",
       [=](Scene& s) {
         s.lights = {{LightFrame::view, ListedLight{{{{0, 0, 1}, 1, {0, nan, 0}}}}}};
       }},
      {"sampling.spacing", [](Scene& s) { s.sampling.spacing = -1; }},
      {"sampling.spacing", [=](Scene& s) { s.sampling.spacing = nan; }},
      {"sampling.segments", [](Scene& s) { s.sampling.segments = 9; }},
      {"sampling.bits", [](Scene& s) { s.sampling.bits = 24; }},
      {"sampling.saturation", [](Scene& s) { s.sampling.saturation = 1; }},
      {"occlusion.theta", [](Scene& s) { s.occlusion.aperture = std::numbers::pi / 2; }},
      {"occlusion.theta", [](Scene& s) { s.occlusion.aperture = -1e-9; }},
      {"occlusion.footprint", [](Scene& s) { s.occlusion.dos.footprint = 17; }},
      {"occlusion.passes", [](Scene& s) { s.occlusion.dos.passes = 0; }},
      {"occlusion.algorithm", [](Scene& s) { s.occlusion.dos.algorithm = 1; }},
      {"occlusion.bits", [](Scene& s) { s.occlusion.bits = 8; }},
      {"clip.planes[0]", [](Scene& s) { s.clipPlanes = {ClipPlane(0, 0, 0, 1)}; }},
      {"clip.planes[1]",
       [=](Scene& s) {
         s.clipPlanes = {ClipPlane(1, 0, 0, 1), ClipPlane(1, 0, 0, nan)};
       }},
      {"clip.box", [](Scene& s) { s.clipBox = Box{}; }},
      {"bricks.interior", [](Scene& s) { s.bricks.interior = 12; }},
      {"bricks.interior", [](Scene& s) { s.bricks.interior = 264; }},
      {"bricks.format", [](Scene& s) { s.bricks.format = "R8"; }},
      {"bricks.budgetMiB", [](Scene& s) { s.bricks.budgetMiB = 0; }},
  };
  for (const Case& c : cases) {
    Scene scene;
    validateScene(scene);
    c.change(scene);
    INFO(c.field);
    CHECK_THROWS_WITH(validateScene(scene), Catch::Matchers::StartsWith(c.field));
  }
}

TEST_CASE("Segments are the fewest that are short enough, as long as there are not more than 8", "[scene]") {
  for (const double slab : {0.01, 0.625, 0.7, 1.25, 1.3, 4.9, 5.0})
    for (const double voxel : {0.3, 1.0, 2.5}) {
      CAPTURE(slab, voxel);
      const int segments = segmentsOf(slab * voxel / voxel);  // differs from slab by a rounding
      CHECK(slab / segments <= kSegmentVoxels * (1 + 1e-9));
      if (segments > 1) CHECK(slab / (segments - 1) > kSegmentVoxels);
    }
  CHECK(segmentsOf(1) == 2);
  CHECK(segmentsOf(100) == kMostSegments);
}

TEST_CASE("The bundled scenes are valid", "[scene]") {
  for (const auto& entry : fs::directory_iterator(fs::path(UMBRICK_ASSETS) / "scenes"))
    if (entry.path().extension() == ".json") CHECK_NOTHROW(readScene(entry.path()));
  const Scene head = readScene(fs::path(UMBRICK_ASSETS) / "scenes" / "head.json");
  CHECK(head.model == Model::cone);
  CHECK(head.transfer == loadTransferFunction("ct-head"));
}

// Pictures of earlier versions have this size in their headers.
TEST_CASE("The size of a table that no longer exists is read and has no effect", "[scene]") {
  const Scene scene = parseScene(R"({"sampling": {"spacing": 0.25, "tableSize": 512}})", "old.json");
  CHECK(scene.sampling.spacing == 0.25);
  CHECK(printScene(scene).find("tableSize") == std::string::npos);
}
