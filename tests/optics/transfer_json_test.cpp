// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "support/random_transfer.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"
#include "umbrick/optics/transfer_function.h"

using namespace umbrick;
using Catch::Contains;

namespace {
TransferFunction parse(const std::string& text) { return parseTransferFunction(text, "tf.json"); }
std::string paraView(const std::string& fields) { return R"([{"Name": "map", )" + fields + "}]"; }
}  // namespace

TEST_CASE("Printed transfer functions parse back to the same function", "[optics]") {
  std::mt19937 random(21);
  for (int i = 0; i < 50; ++i) {
    const TransferFunction f = i % 2 ? randomTransferFunction(random, 1 + i) : randomTransferFunction2d(random, 4);
    CHECK(parse(printTransferFunction(f)) == f);
  }
}

TEST_CASE("Window and scale of a file are applied", "[optics]") {
  const std::string points = R"("points": [{"value": 0, "albedo": [1, 0.5, 0], "sigma_t": 0},
                                           {"value": 1, "albedo": [1, 1, 1], "sigma_t": 2}])";
  const TransferFunction f = parse("{" + points + R"(, "window": [100, 300], "sigmaScale": 3, "description": "x"})");
  CHECK(f == parse("{" + points + "}").windowed(100, 300).scaled(3));
  CHECK(f(200).sigma_t == Approx(3));
}

TEST_CASE("A lattice file holds values fastest", "[optics]") {
  const TransferFunction f = parse(R"({"values": [0, 10], "gradients": [0, 1, 2],
      "albedo": [[0,0,0],[0,0,0],[0,0,0],[1,1,1],[0,0,0],[0,0,0]], "sigma_t": [0, 1, 2, 3, 4, 5]})");
  CHECK(f(10, 1).sigma_t == 3);
  CHECK(f(10, 1).albedo.g == 1);
  CHECK(f(0, 2).sigma_t == 4);
}

TEST_CASE("Malformed transfer functions are refused with line, column and field", "[optics]") {
  CHECK_THROWS_WITH(parse("{\"points\": [{\"value\": 1, \"albedo\": [1, 1, 1],\n\"sigma_t\": -1}]}"),
                    "tf.json:2:12: points[0].sigma_t: expected a number >= 0, found -1");
  CHECK_THROWS_WITH(parse(R"({"points": [{"value": 1, "albedo": [1, 2, 1], "sigma_t": 1}]})"),
                    "tf.json:1:40: points[0].albedo[1]: expected a number from 0 to 1, found 2");
  CHECK_THROWS_WITH(parse(R"({"points": [{"value": 1, "albedo": [1, 1, 1]}]})"),
                    Contains("points[0]: the field 'sigma_t' is missing"));
  CHECK_THROWS_WITH(parse(R"({"points": [{"value": 2, "albedo": [1, 1, 1], "sigma_t": 1},
                                          {"value": 1, "albedo": [1, 1, 1], "sigma_t": 1}]})"),
                    Contains("points[1].value: expected a value no smaller"));
  CHECK_THROWS_WITH(parse(R"({"points": []})"), Contains("points: at least one"));
  CHECK_THROWS_WITH(parse(R"({"point": []})"), Contains("did you mean 'points'?"));
  CHECK_THROWS_WITH(parse("{}"), Contains("needs 'points'"));
  CHECK_THROWS_WITH(parse("7"), "tf.json:1:1: expected an object, or the array of a ParaView colour map, found 7");
  CHECK_THROWS_WITH(parse(R"({"points": [{"value": 1, "albedo": [1, 1, 1], "sigma_t": 1}], "window": [2, 1]})"),
                    Contains("window: expected two numbers that ascend, found [2, 1]"));
  CHECK_THROWS_WITH(parse(R"({"points": [{"value": 1, "albedo": [1, 1, 1], "sigma_t": 1}], "values": [2, 1]})"),
                    Contains("values: belongs to a 2D function"));
  CHECK_THROWS_WITH(parse(R"({"values": [0, 1], "gradients": [0], "albedo": [[1,1,1]], "sigma_t": [1]})"),
                    Contains("albedo: expected an array of 2, found an array of 1"));
}

TEST_CASE("Presets and files are found by name, and other names are refused", "[optics]") {
  const std::vector<std::string> presets = transferPresets();
  for (const char* name : {"cloud", "ct-bone", "ct-head", "explosion", "fire", "grey-ramp", "smoke"})
    CHECK(std::find(presets.begin(), presets.end(), name) != presets.end());
  for (const std::string& name : presets) {
    const TransferFunction f = loadTransferFunction(name);
    CHECK(f(f.valueDomain().min).sigma_t == 0);  // air is not seen
    CHECK(f.majorant(f.valueDomain()) > 0);
  }
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "mine.json").string();
  std::ofstream(file) << printTransferFunction(loadTransferFunction("smoke"));
  CHECK(loadTransferFunction(file) == loadTransferFunction("smoke"));
  CHECK_THROWS_WITH(loadTransferFunction("smoek"), Contains("smoek") && Contains("grey-ramp, smoke"));
  CHECK_THROWS_WITH(loadTransferFunction(folder.path().string()), Contains("is a directory"));
}

TEST_CASE("ParaView colours become linear albedo and opacities extinction per unit distance", "[optics]") {
  const TransferFunction f = parse(paraView(R"("ColorSpace": "RGB", "Creator": "ParaView", "NanColor": [1, 1, 0],
      "RGBPoints": [0, 0.5, 0, 1, 10, 0.5, 1, 0], "Points": [0, 0, 0.5, 0, 10, 0.75, 0.5, 0],
      "ScalarOpacityUnitDistance": 2)"));
  CHECK(f(0).albedo.r == Approx(0.21404114));  // IEC 61966-2-1 of 0.5
  CHECK(f(10).sigma_t == Approx(std::log(4.0) / 2));
  // Everywhere the function is within a level of 8 bits of the curves that ParaView draws.
  for (double value = 0; value <= 10; value += 0.013) {
    CHECK(linearToSrgb(f(value).albedo.g) == Approx(value / 10).margin(1 / 255.0));
    CHECK(1 - std::exp(-2 * f(value).sigma_t) == Approx(0.075 * value).margin(1 / 255.0));
  }
}

TEST_CASE("ParaView's missing opacities rise to the most opaque medium", "[optics]") {
  const TransferFunction f = parse(paraView(R"("ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1])"));
  CHECK(f(0).sigma_t == 0);
  CHECK(f(1).sigma_t == Approx(-std::log(0.001)));
  CHECK(1 - std::exp(-f(0.5).sigma_t) == Approx(0.5));
}

// The colours were computed independently, with vtkColorTransferFunction of VTK 9.1.
TEST_CASE("ParaView's colour spaces give VTK's colours", "[optics]") {
  struct Expected {
    const char* space;
    double value;
    glm::dvec3 display;
  };
  const Expected table[] = {
      {R"("RGB")", 0.3, {0.37350, 0.21340, 0.57210}},       {R"("HSV")", 0.1, {0.24343, 0.20830, 0.74830}},
      {R"("HSV")", 0.5, {0.63123, 0.12016, 0.72950}},       {R"("HSV")", 0.8, {0.71540, 0.05686, 0.43949}},
      {R"("Lab")", 0.1, {0.35548, 0.28047, 0.68931}},       {R"("Lab")", 0.5, {0.58055, 0.20256, 0.44355}},
      {R"("Diverging")", 0.1, {0.35157, 0.46849, 0.89045}}, {R"("Diverging")", 0.3, {0.62235, 0.74648, 0.99952}},
      {R"("Diverging")", 0.5, {0.86540, 0.86541, 0.86540}}, {R"("Diverging")", 0.8, {0.93276, 0.51968, 0.40642}},
      {R"("Step")", 0.1, {0.70600, 0.01600, 0.15000}},      {R"("Step")", 0.8, {0.70600, 0.01600, 0.15000}},
  };
  const std::string points = R"("RGBPoints": [0, 0.231, 0.298, 0.753, 1, 0.706, 0.016, 0.15], "ColorSpace": )";
  for (const Expected& e : table) {
    const TransferFunction f = parse(paraView(points + e.space));
    INFO(e.space << " at " << e.value);
    for (int c = 0; c < 3; ++c)  // one level of 8 bits, for which the pieces are chosen
      CHECK(linearToSrgb(f(e.value).albedo[c]) == Approx(e.display[c]).margin(1 / 255.0));
  }
}

TEST_CASE("ParaView's hues go the short way round when they wrap", "[optics]") {
  const auto display = [](const std::string& wrap) {
    const TransferFunction f = parse(
        paraView(R"("RGBPoints": [0, 0.9, 0.6, 0.1, 1, 0.6, 0.1, 0.5], "ColorSpace": "HSV", "HSVWrap": )" + wrap));
    const glm::dvec3 c = f(0.3).albedo;
    return glm::dvec3(linearToSrgb(c.r), linearToSrgb(c.g), linearToSrgb(c.b));
  };
  for (int c = 0; c < 3; ++c) {  // from VTK 9.1
    CHECK(display("1")[c] == Approx(glm::dvec3(0.81000, 0.24303, 0.10350)[c]).margin(1 / 255.0));
    CHECK(display("0")[c] == Approx(glm::dvec3(0.10527, 0.81000, 0.10350)[c]).margin(1 / 255.0));
  }
}

// The opacities were computed with vtkPiecewiseFunction of VTK 9.1.
TEST_CASE("Midpoint and sharpness bend the opacity as in VTK", "[optics]") {
  const TransferFunction f = parse(paraView(
      R"("RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1], "ColorSpace": "RGB", "Points": [0, 0.1, 0.3, 0.4, 1, 0.9, 0.5, 0])"));
  const double expected[][2] = {{0.1, 0.100992}, {0.3, 0.5}, {0.5, 0.847593}, {0.7, 0.89648}, {0.9, 0.899986}};
  for (const auto& [value, opacity] : expected)
    CHECK(1 - std::exp(-f(value).sigma_t) == Approx(opacity).margin(1 / 255.0));
}

TEST_CASE("A sharp ParaView opacity is a step at its midpoint", "[optics]") {
  const TransferFunction f = parse(paraView(
      R"("ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1], "Points": [0, 0, 0.25, 1, 1, 0.5, 0.5, 0])"));
  CHECK(f(0.2499).sigma_t == 0);
  CHECK(f(0.2501).sigma_t == Approx(std::log(2.0)));
  CHECK(f.isTransparent({0, 0.2499f}));
}

TEST_CASE("Colour maps of ParaView are refused that are malformed or that we cannot represent", "[optics]") {
  CHECK_THROWS_WITH(parse("[]"), Contains("expected one colour map, found 0"));
  CHECK_THROWS_WITH(parse(R"([{"Name": "a", "IndexedColors": [1, 1, 1]}])"), Contains("[0]: the field 'RGBPoints'"));
  CHECK_THROWS_WITH(parse(paraView(R"("RGBPoints": [0, 0, 0, 0, 1])")),
                    Contains("[0].RGBPoints: expected groups of 4"));
  CHECK_THROWS_WITH(parse(paraView(R"("RGBPoints": [0, 0, 0, 2])")),
                    Contains("[0].RGBPoints[3]: expected a number from"));
  CHECK_THROWS_WITH(parse(paraView(R"("RGBPoints": [0, 0, 0, 0], "ColorSpace": "CMYK")")),
                    Contains("[0].ColorSpace: expected one of RGB, HSV"));
  CHECK_THROWS_WITH(parse(paraView(R"("RGBPoints": [0, 0, 0, 0], "UseLogScale": 1)")), Contains("logarithmic"));
}
