// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/formula_pictures.h"
#include "tools/program.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/colour_map.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/image/png.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;
using nlohmann::json;

namespace {

const float kInfinity = std::numeric_limits<float>::infinity();

void write(const TemporaryFolder& folder, const std::string& name, const std::vector<ImageLayer>& layers) {
  ExrOptions options;
  options.pixel = ExrPixel::float32;
  writeExr(folder.path() / name, layers, options);
}

// Two pictures, a.exr and b.exr: RGB differs by 0.0625 everywhere, alpha not.
struct Offset {
  TemporaryFolder folder;
  Offset() {
    write(folder, "a.exr", {{"", solid(20, 16, 0.25f, 0.5f, 0.125f)}});
    write(folder, "b.exr", {{"", solid(20, 16, 0.3125f, 0.4375f, 0.1875f)}});
  }
  ProgramResult run(const std::string& arguments) const { return runProgram(folder, "compare " + arguments); }
};

void checkFails(const TemporaryFolder& folder, const std::string& arguments, int status, const std::string& message) {
  CAPTURE(arguments);
  const std::size_t before = filesIn(folder);
  const ProgramResult result = runProgram(folder, "compare " + arguments);
  CHECK(result.status == status);
  CHECK_THAT(result.err, Contains(message));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.out.empty());
  CHECK(filesIn(folder) == before);
}

}  // namespace

TEST_CASE("Equal pictures keep the strictest limits", "[tools]") {
  const Offset files;
  const ProgramResult result = files.run(
      "a.exr a.exr --max-rmse 0 --max-rmse-rgb 0 --max-error 0 --max-p999 0 --max-relmse 0 --max-flip 0 --min-ssim 1");
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK_THAT(result.out, Contains("20 x 16") && Contains("RMSE") && Contains("RGBA"));
}

TEST_CASE("Each limit holds on one side of the value and fails on the other", "[tools]") {
  const Offset files;
  const json layer = json::parse(files.run("a.exr b.exr --json").out).at("layers").at(0);
  struct Limit {
    const char *option, *key, *title;
    int better;  // direction in which the limit is easier to keep
  };
  for (const Limit& limit : {Limit{"--max-rmse", "rmse", "RMSE", 1}, Limit{"--max-rmse-rgb", "rmse_rgb", "RMSE RGB", 1},
                             Limit{"--max-error", "max_error", "maximum", 1}, Limit{"--max-p999", "p999", "99.9 %", 1},
                             Limit{"--max-relmse", "rel_mse", "relMSE", 1}, Limit{"--min-ssim", "ssim", "SSIM", -1},
                             Limit{"--max-flip", "flip", "FLIP", 1}}) {
    const double value = layer.at(limit.key);
    CAPTURE(limit.option, value);
    CHECK(value > 1e-3);
    CHECK(value < 0.9999);
    const auto run = [&](double share) {
      return files.run("a.exr b.exr " + std::string(limit.option) + " " + std::to_string(value * share));
    };
    const ProgramResult kept = run(1 + 3e-4 * limit.better), failed = run(1 - 3e-4 * limit.better);
    CHECK(kept.status == 0);
    CHECK(kept.err.empty());
    CHECK(failed.status == 1);
    CHECK_THAT(failed.err, Contains("umbrick: RGBA: " + std::string(limit.title) + " is ") &&
                               Contains(", " + std::string(limit.option) + " is "));
    CHECK(std::count(failed.err.begin(), failed.err.end(), '\n') == 1);
    CHECK(failed.out == kept.out);  // what was measured is printed in both cases
  }
  CHECK(files.run("a.exr b.exr --max-error 0.0625").status == 0);  // a value equal to the limit is allowed
  const ProgramResult two = files.run("a.exr b.exr --max-rmse 0.01 --min-ssim 1 --max-error 1");
  CHECK(two.status == 1);
  CHECK_THAT(two.err, Contains("RMSE is 0.0541265877, --max-rmse is 0.01\n") && Contains("SSIM is"));
  CHECK(std::count(two.err.begin(), two.err.end(), '\n') == 2);
}

TEST_CASE("The JSON holds what the library measures", "[tools]") {
  const TemporaryFolder folder;
  Image test = formulaPicture(Formula::shifted), reference = formulaPicture(Formula::smooth);
  test.at(50, 40)[1] = 3;
  write(folder, "a.exr", {{"", test}, {"V", Image(64, 48, 1)}});
  write(folder, "b.exr", {{"", reference}, {"V", Image(64, 48, 1)}});
  const ProgramResult result =
      runProgram(folder, "compare a.exr b.exr --json --ppd 30 --background 1 0 0.5 --max-rmse 0.001");
  CHECK(result.status == 1);
  const json report = json::parse(result.out);
  CHECK(report.at("test") == "a.exr");
  CHECK(report.at("reference") == "b.exr");
  CHECK(report.at("size") == json{64, 48});
  CHECK(report.at("pixels_per_degree") == 30);
  CHECK(report.at("background") == json{1, 0, 0.5});
  CHECK(report.at("passed") == false);
  DifferenceOptions options;
  options.background = {1, 0, 0.5};
  options.pixelsPerDegree = 30;
  const ImageDifference expected = differenceOf(test, reference, options);
  REQUIRE(report.at("layers").size() == 2);
  const json& layer = report.at("layers").at(0);
  CHECK(layer.at("name") == "RGBA");
  CHECK(layer.at("channels") == 4);
  CHECK(layer.at("rmse") == expected.rmse);
  CHECK(layer.at("rmse_rgb") == *expected.rmseRgb);
  CHECK(layer.at("max_error") == expected.maxError);
  CHECK(layer.at("max_error_pixel") == json{50, 7});  // counted from the top left: 48 - 1 - 40
  CHECK(layer.at("p999") == expected.p999);
  CHECK(layer.at("rel_mse") == expected.relMse);
  CHECK(layer.at("ssim") == *expected.ssim);
  CHECK(layer.at("flip") == *expected.flip);
  CHECK(layer.at("non_finite_differing") == 0);
  const json& single = report.at("layers").at(1);
  CHECK(single.at("name") == "V");
  CHECK(single.at("rmse") == 0);
  for (const char* key : {"rmse_rgb", "ssim", "flip"}) CHECK(single.at(key).is_null());
  const json& limits = report.at("limits");
  REQUIRE(limits.size() == 2);  // one for each of both layers
  CHECK(limits.at(0) ==
        json{{"layer", "RGBA"}, {"measure", "rmse"}, {"value", expected.rmse}, {"limit", 0.001}, {"passed", false}});
  CHECK(limits.at(1).at("passed") == true);
}

TEST_CASE("Both files must hold the same layers, unless the layers to compare are named", "[tools]") {
  const TemporaryFolder folder;
  const Image colour = solid(12, 12, 0.5f, 0.5f, 0.5f), other = solid(12, 12, 0.25f, 0.25f, 0.25f), single(12, 12, 1);
  write(folder, "a.exr", {{"", colour}, {"V", single}, {"Z", single}});
  write(folder, "b.exr", {{"", other}, {"V", single}});
  write(folder, "z.exr", {{"Z", single}});
  write(folder, "rgb.exr", {{"", Image(12, 12, 3)}});
  write(folder, "light.exr", {{"", colour}, {"V", Image(12, 12, 3)}});
  writePng(folder.path() / "a.png", colour);
  checkFails(folder, "a.exr b.exr", 1,
             "different layers: a.exr has RGBA, V, Z, b.exr has RGBA, V; to compare what both have: --layer RGBA "
             "--layer V\n");
  checkFails(folder, "b.exr a.exr", 1, "different layers: b.exr has RGBA, V, a.exr has RGBA, V, Z");
  checkFails(folder, "rgb.exr z.exr", 1, "different layers: rgb.exr has RGB, z.exr has Z\n");
  checkFails(folder, "a.png a.exr", 1, "different layers: a.png has RGBA, a.exr has RGBA, V, Z");
  checkFails(folder, "a.exr b.exr --layer Z", 1, "b.exr: no layer \"Z\": the file has RGBA, V");
  checkFails(folder, "a.exr a.exr --layer W", 1, "a.exr: no layer \"W\": the file has RGBA, V, Z");
  checkFails(folder, "b.exr light.exr", 1, "layer V: b.exr has 1 channels, light.exr has 3");
  const auto layers = [&](const std::string& arguments) {
    const ProgramResult result = runProgram(folder, "compare --json " + arguments);
    CHECK(result.status == 0);
    std::vector<std::string> names;
    const json report = json::parse(result.out);
    for (const json& layer : report.at("layers")) names.push_back(layer.at("name"));
    return names;
  };
  CHECK(layers("a.exr a.exr") == std::vector<std::string>{"RGBA", "V", "Z"});
  CHECK(layers("--layer RGBA a.exr b.exr") == std::vector<std::string>{"RGBA"});
  CHECK(layers("a.exr b.exr --layer V --layer RGBA") == std::vector<std::string>{"V", "RGBA"});
  CHECK(layers("a.exr z.exr --layer Z") == std::vector<std::string>{"Z"});
  CHECK(layers("rgb.exr rgb.exr") == std::vector<std::string>{"RGB"});
  // The error is half a byte where the sRGB curve has the slope 1.52.
  CHECK(layers("a.png a.exr --layer RGBA --max-error 0.003") == std::vector<std::string>{"RGBA"});
  // A limit does not apply to layers that do not have its measure.
  CHECK(layers("a.exr a.exr --min-ssim 0.9") == std::vector<std::string>{"RGBA", "V", "Z"});
  checkFails(folder, "a.exr a.exr --layer V --min-ssim 0.9", 1, "--min-ssim: no layer that is compared has SSIM");
  checkFails(folder, "a.exr a.exr --layer V --flip-map f.png", 1, "--flip-map: no layer that is compared has FLIP");
}

TEST_CASE("A value that is finite in one picture only fails every limit", "[tools]") {
  const TemporaryFolder folder;
  Image colour = formulaPicture(Formula::smooth), depth(64, 48, 1), deeper = depth;
  depth.at(0, 0)[0] = deeper.at(0, 0)[0] = kInfinity;
  write(folder, "a.exr", {{"", colour}, {"Z", depth}});
  deeper.at(3, 3)[0] = kInfinity;
  colour.at(5, 5)[2] = std::numeric_limits<float>::quiet_NaN();
  write(folder, "b.exr", {{"", colour}, {"Z", deeper}});
  const ProgramResult same = runProgram(folder, "compare a.exr a.exr --max-error 0");
  CHECK(same.status == 0);
  CHECK_THAT(same.out, Contains("Z: 1 pixel with the same NaN or infinity in both pictures, counted as equal"));
  for (const char* limit : {"--max-p999 100", "--max-rmse 100", "--min-ssim 0", "--max-flip 1"}) {
    CAPTURE(limit);
    const ProgramResult result = runProgram(folder, "compare a.exr b.exr --layer RGBA " + std::string(limit));
    CHECK(result.status == 1);
    CHECK_THAT(result.err, Contains("umbrick: RGBA: 1 pixel with NaN or infinity in one picture only"));
  }
  const ProgramResult result = runProgram(folder, "compare a.exr b.exr --json --layer Z");
  CHECK(result.status == 0);  // no limit was asked for
  const json layer = json::parse(result.out).at("layers").at(0);
  CHECK(layer.at("rmse") == "inf");
  CHECK(layer.at("max_error") == "inf");
  CHECK(layer.at("non_finite_differing") == 1);
  CHECK(layer.at("non_finite_equal") == 1);
}

TEST_CASE("The PNG of the difference shows its size times the gain, byte by byte", "[tools]") {
  const Offset files;
  REQUIRE(files.run("a.exr b.exr --difference d.png --gain 4").status == 0);
  const Image shown = readPng(files.folder.path() / "d.png");
  REQUIRE(shown.width == 20);
  REQUIRE(shown.height == 16);
  for (int c = 0; c < 3; ++c)  // half a step of a byte
    CHECK(linearToSrgb(shown.at(7, 9)[c]) == Approx(4 * 0.0625).margin(0.5 / 255));
  CHECK(shown.at(7, 9)[3] == 1);
}

TEST_CASE("The EXR of the difference holds test minus reference of all layers", "[tools]") {
  const TemporaryFolder folder;
  Image test(12, 11, 1), reference(12, 11, 1);
  test.at(2, 3)[0] = 5;
  reference.at(4, 3)[0] = 1.5f;
  test.at(0, 0)[0] = reference.at(0, 0)[0] = kInfinity;
  const Image a = solid(12, 11, 0.25f, 0.5f, 0.125f), b = solid(12, 11, 0.5f, 0.25f, 0.125f, 0.5f);
  write(folder, "a.exr", {{"", a}, {"Z", test}});
  write(folder, "b.exr", {{"", b}, {"Z", reference}});
  REQUIRE(runProgram(folder, "compare a.exr b.exr --difference d.exr").status == 0);
  const ExrFile file = readExr(folder.path() / "d.exr");
  REQUIRE(file.layers.size() == 2);
  CHECK(file.layers[0].name.empty());
  CHECK(file.layers[0].image.pixels == signedDifference(a, b).pixels);
  CHECK(file.layers[1].name == "Z");
  CHECK(file.layers[1].image.pixels == signedDifference(test, reference).pixels);
}

TEST_CASE("The FLIP map is written as magma or as numbers", "[tools]") {
  const TemporaryFolder folder;
  const Image a = formulaPicture(Formula::waves), b = formulaPicture(Formula::checks);
  write(folder, "a.exr", {{"V", Image(64, 48, 1)}, {"", a}});
  write(folder, "b.exr", {{"V", Image(64, 48, 1)}, {"", b}});
  REQUIRE(runProgram(folder, "compare a.exr b.exr --flip-map f.png").status == 0);
  REQUIRE(runProgram(folder, "compare a.exr b.exr --flip-map f.exr --ppd 20").status == 0);
  const Image map = flipMap(a, b), shown = readPng(folder.path() / "f.png");
  for (const int x : {0, 20, 63})
    for (int c = 0; c < 3; ++c)  // half a step of a byte
      CHECK(linearToSrgb(shown.at(x, 30)[c]) == Approx(magma(map.at(x, 30)[0])[c]).margin(0.501 / 255));
  const ExrFile file = readExr(folder.path() / "f.exr");
  REQUIRE(file.layers.size() == 1);
  CHECK(file.layers[0].name == "FLIP");
  CHECK(file.layers[0].image.pixels == flipMap(a, b, glm::dvec3(0), 20).pixels);
}

TEST_CASE("Pictures that cannot be compared are an error that names them and leaves nothing", "[tools]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path();
  write(folder, "a.exr", {{"", formulaPicture(Formula::noise)}});
  write(folder, "small.exr", {{"", solid(32, 48, 0, 0, 0)}});
  const std::string whole = readBytes(path / "a.exr");
  writeBytes(path / "cut.exr", whole.substr(0, whole.size() / 2));
  writeBytes(path / "text.exr", "not a picture");
  writeBytes(path / "text.png", "not a picture");
  checkFails(folder, "a.exr small.exr --difference d.png", 1,
             "different sizes: a.exr has 64 x 48 pixels, small.exr has 32 x 48");
  checkFails(folder, "a.exr none.exr --difference d.exr", 1, "none.exr: cannot read: No such file");
  checkFails(folder, "none.png a.exr", 1, "none.png: cannot read: No such file");
  checkFails(folder, "cut.exr a.exr --difference d.exr", 1, "cut.exr: cannot read: ");
  checkFails(folder, "a.exr text.exr", 1, "text.exr: not an EXR file");
  checkFails(folder, "text.png a.exr", 1, "text.png: not a PNG file");
  checkFails(folder, "a.exr . --json", 1, "is a directory");
  checkFails(folder, "a.exr a.exr --difference none/d.exr", 1, "none/d.exr: cannot write");
  checkFails(folder, "a.exr a.exr --flip-map none/f.png", 1, "none/f.png: cannot write");
}

TEST_CASE("Wrong usage of compare ends with exit status 2", "[tools]") {
  const Offset files;
  checkFails(files.folder, "a.exr", 2, "reference is required");
  checkFails(files.folder, "a.exr b.exr b.exr", 2, "b.exr");
  checkFails(files.folder, "a.exr b.exr --max-rmse -0.1", 2, "--max-rmse: expected a number >= 0, found -0.1");
  checkFails(files.folder, "a.exr b.exr --max-error nan", 2, "--max-error: expected a number >= 0, found nan");
  checkFails(files.folder, "a.exr b.exr --max-flip inf", 2, "--max-flip");
  checkFails(files.folder, "a.exr b.exr --max-p999 small", 2, "--max-p999");
  checkFails(files.folder, "a.exr b.exr --min-ssim 1.5", 2, "--min-ssim: expected a number from -1 to 1, found 1.5");
  checkFails(files.folder, "a.exr b.exr --ppd 0", 2, "--ppd: expected a number from 1 to 1000, found 0");
  checkFails(files.folder, "a.exr b.exr --background 1 1", 2, "--background");
  checkFails(files.folder, "a.exr b.exr --background 1 1 2", 2, "--background: expected a number from 0 to 1, found 2");
  checkFails(files.folder, "a.exr b.exr --gain 2", 2, "--gain requires --difference");
  checkFails(files.folder, "a.exr b.exr --difference d.png --gain 0", 2, "--gain: expected a number > 0, found 0");
  checkFails(files.folder, "a.exr b.exr --difference d.jpg", 2, "d.jpg: expected a picture that ends in .exr or .png");
  checkFails(files.folder, "a.exr b.exr --difference b.exr", 2, "b.exr: named twice");
  checkFails(files.folder, "a.exr b.exr --difference d.png --flip-map ./d.png", 2, "d.png: named twice");
  checkFails(files.folder, "a.exr b.exr --flip-map f", 2, "f: expected a picture that ends in .exr or .png");
}
