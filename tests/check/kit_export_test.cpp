// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/kit_export.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <set>

#include "check/kit_support.h"
#include "support/complaint.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("A kit's values equal interpolation of its raw files", "[check]") {
  const KitFolder kit({hardCase("crooked"), hardCase("far-index"), hardCase("background")});
  for (const std::string name : {"crooked", "far-index", "background"}) {
    const KitInput input = kit.input(name);
    const auto columns = readColumns(kit.caseFolder(name) / "samples.csv");
    const std::vector<double> x = numbersOf(columns.at("x")), y = numbersOf(columns.at("y")),
                              z = numbersOf(columns.at("z"));
    const glm::dmat4 toWorld = KitInput::matrix(input.json["volume"]["index_to_world"]);
    const glm::dmat4 toIndex = KitInput::matrix(input.json["volume"]["world_to_index"]);
    const double extent =
        input.json["volume"]["value_range"][1].get<double>() - input.json["volume"]["value_range"][0].get<double>();
    double worst = 0, misplaced = 0, misindexed = 0;
    std::size_t count = 0;
    kit.answerSamples(name, [&](std::size_t id, const glm::dvec3& index, double exact) {
      worst = std::max(worst, std::abs(input.value(index) - exact));
      const glm::dvec3 world(x[id], y[id], z[id]);
      misplaced = std::max(misplaced, glm::length(glm::dvec3(toWorld * glm::dvec4(index, 1)) - world));
      misindexed = std::max(misindexed, glm::length(glm::dvec3(toIndex * glm::dvec4(world, 1)) - index));
      ++count;
      return exact;
    });
    CAPTURE(name);
    CHECK(count == 600);
    // Double precision: indices of 2e6 have 2e-10 left behind the point.
    CHECK(worst <= 1e-9 * extent);
    CHECK(misplaced <= 1e-9);
    CHECK(misindexed <= 1e-8);
  }
}

// Each brick alone is enough to interpolate wherever it owns the point.
TEST_CASE("A kit's bricks hold the voxels of the volume, aprons included, raw and as grids", "[check]") {
  const KitFolder kit({hardCase("noise")});
  const KitInput input = kit.input("noise");
  const auto table = readColumns(kit.caseFolder("noise") / "bricks.csv");
  const std::vector<float> raw = readFloats(kit.caseFolder("noise") / "bricks.raw");
  const int edge = input.json["bricks"]["edge"][0], apron = input.json["bricks"]["apron"];
  CHECK(edge == 10);
  CHECK(apron == 1);
  const std::size_t count = input.json["bricks"]["count"], voxels = 1000;
  REQUIRE(raw.size() == count * voxels);
  REQUIRE(kit.summary.bricks == count);
  std::size_t different = 0, outOfRange = 0;
  for (std::size_t brick = 0; brick < count; ++brick) {
    const auto number = [&](const char* column) { return std::stod(table.at(column)[brick]); };
    CHECK(number("byte_offset") == static_cast<double>(4 * brick * voxels));
    const glm::dvec3 origin(number("origin_i"), number("origin_j"), number("origin_k"));
    const double low = number("value_min"), high = number("value_max");
    for (int n = 0; n < edge * edge * edge; ++n) {
      const glm::dvec3 at = origin - 1.0 + glm::dvec3(n % edge, n / edge % edge, n / edge / edge);
      const float value = raw[brick * voxels + static_cast<std::size_t>(n)];
      different += value != static_cast<float>(input.voxel(at));
      outOfRange += value < low || value > high;
    }
  }
  CHECK(different == 0);
  CHECK(outOfRange == 0);
  const ScalarGrid first = readScalarGrid(kit.caseFolder("noise") / "bricks.vdb", "brick_0");
  const glm::ivec3 corner(std::stoi(table.at("origin_i")[0]) - 1, std::stoi(table.at("origin_j")[0]) - 1,
                          std::stoi(table.at("origin_k")[0]) - 1);
  CHECK(first.activeBox() == IndexBox{corner, corner + 9});
}

// Whoever reads the README needs no more than the files: a march written from it, in steps, makes the same picture.
TEST_CASE("A kit's matrices, tables and model are enough to make its pictures", "[check]") {
  const KitFolder kit({hardCase("crooked"), hardCase("background"), hardCase("slab"), hardCase("inside")});
  const std::pair<std::string, std::string> views[]{
      {"crooked", "oblique"}, {"background", "front"}, {"slab", "backdrop"}, {"inside", "wide"}};
  for (const auto& [name, view] : views) {
    const KitInput input = kit.input(name);
    const auto& pictures = input.json["pictures"];
    const auto picture =
        std::find_if(pictures.begin(), pictures.end(), [&, v = view](const auto& each) { return each["name"] == v; });
    REQUIRE(picture != pictures.end());
    const glm::dmat4 toIndex = KitInput::matrix(input.json["volume"]["world_to_index"]);
    const glm::dmat4 fromClip =
        glm::inverse(KitInput::matrix((*picture)["view_to_clip"]) * KitInput::matrix((*picture)["world_to_view"]));
    const glm::dvec3 eye((*picture)["eye"][0], (*picture)["eye"][1], (*picture)["eye"][2]);
    const bool perspective = (*picture)["projection"] == "perspective";
    const int width = (*picture)["width"], height = (*picture)["height"];
    const Image reference = kit.reference(name, view);
    REQUIRE(reference.width == width);
    REQUIRE(reference.height == height);
    double worst = 0, brightest = 0;
    for (int y = 2; y < height; y += 11)
      for (int x = 3; x < width; x += 11) {
        const glm::dvec2 ndc(2 * (x + 0.5) / width - 1, 1 - 2 * (y + 0.5) / height);
        const auto unproject = [&](double depth) {
          const glm::dvec4 p = fromClip * glm::dvec4(ndc, depth, 1);
          return glm::dvec3(p) / p.w;
        };
        const glm::dvec3 direction = glm::normalize(unproject(1) - unproject(-1));
        // A parallel ray begins in the plane of the eye, which lies in front of the volume.
        const glm::dvec3 start =
            perspective ? eye : unproject(-1) - direction * glm::dot(unproject(-1) - eye, direction);
        const glm::dvec3 at(toIndex * glm::dvec4(start, 1)), step(toIndex * glm::dvec4(direction, 0));
        // Midpoints in steps of a 64th of a voxel, as far as twice the volume's distance.
        const double ds = 1 / (64 * glm::length(step));
        const double end = glm::length(at - (input.first + 0.5 * input.dims)) + glm::length(input.dims);
        glm::dvec3 colour(0);
        double through = 1;
        for (double s = 0.5; s * ds * glm::length(step) < end && through > 1e-6; ++s) {
          const glm::dvec4 medium = input.medium(input.value(at + s * ds * step));
          const double kept = std::exp(-medium.w * ds);
          colour += through * (1 - kept) * glm::dvec3(medium);
          through *= kept;
        }
        double alpha = 1 - through;
        if (!(*picture)["background"].is_null()) {
          for (int c = 0; c < 3; ++c)
            colour[c] += through * (*picture)["background"][static_cast<std::size_t>(c)].get<double>();
          alpha = 1;
        }
        const float* expected = reference.at(x, height - 1 - y);
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(colour[c] - expected[c]));
        worst = std::max(worst, std::abs(alpha - expected[3]));
        brightest = std::max(brightest, colour.x);
      }
    CAPTURE(name, view);
    // The march is off by the second order of its step, where extinction is up to 0.8 a voxel with kinks at voxels.
    CHECK(worst < 1e-4);
    CHECK(brightest > 0.05);
  }
}

TEST_CASE("The slab of a kit has the opacity of its closed form, and error bars are small", "[check]") {
  const KitFolder kit({hardCase("slab"), hardCase("opaque")});
  const Image slab = kit.reference("slab", "front"), opaque = kit.reference("opaque", "front");
  CHECK(slab.at(slab.width / 2, slab.height / 2)[3] == Approx(1 - std::exp(-2)).margin(1e-6));
  CHECK(opaque.at(opaque.width / 2, opaque.height / 2)[3] == 1);
  CHECK(kit.summary.largestErrorBar < 1e-4);
  const ExrFile file = readExr(kit.caseFolder("slab") / "front.exr");
  REQUIRE(file.layers.size() == 3);
  std::set<std::string> names;
  for (const ImageLayer& layer : file.layers) names.insert(layer.name);
  CHECK(names == std::set<std::string>{"", "errorBar", "Z"});
}

TEST_CASE("Slices of a kit meet each brick in one polygon, in the picture's coordinates", "[check]") {
  const KitFolder kit({hardCase("noise")});
  const auto slices = nlohmann::json::parse(readBytes(kit.caseFolder("noise") / "front.slices.json"));
  REQUIRE(slices["slices"].size() >= 8);
  std::size_t polygons = 0;
  double area = 0;
  for (const auto& slice : slices["slices"]) {
    std::set<int> bricks;
    for (const auto& polygon : slice["polygons"]) {
      CHECK(bricks.insert(polygon["brick"].get<int>()).second);
      const auto& ndc = polygon["ndc"];
      REQUIRE(ndc.size() >= 3);
      for (std::size_t i = 0; i < ndc.size(); ++i) {
        const auto &a = ndc[i], &b = ndc[(i + 1) % ndc.size()];
        area += 0.5 * (a[0].get<double>() * b[1].get<double>() - a[1].get<double>() * b[0].get<double>());
      }
      ++polygons;
    }
  }
  CHECK(polygons > 8);
  // Seen from the front, each slice through the middle of the lattice of 3 x 3 bricks of 8 voxels covers 24 x 24 of
  // them, and no slice more: polygons do not overlap.
  const KitInput input = kit.input("noise");
  const double viewHeight = input.json["pictures"][0]["view_height"];
  const double lattice = 24.0 * 24.0 / (viewHeight * viewHeight * 64 / 48) * 4;
  CHECK(std::abs(area) <= lattice * static_cast<double>(slices["slices"].size()) * 1.001);
  CHECK(std::abs(area) >= 0.5 * lattice * static_cast<double>(slices["slices"].size()));
}

TEST_CASE("A kit goes to a new folder, whole or not at all", "[check]") {
  const TemporaryFolder folder;
  const auto filesBeside = [&] { return std::distance(fs::directory_iterator(folder.path()), {}); };
  const std::vector<KitCase> cases{hardCase("single-voxel")};
  fs::create_directory(folder.path() / "full");
  writeBytes(folder.path() / "full" / "mine.txt", "mine");
  writeBytes(folder.path() / "file", "mine");
  const auto refusal = [&](const std::string& name) {
    return complaint<InvalidArgument>([&] { exportKit(folder.path() / name, cases); });
  };
  CHECK_THAT(refusal("full"), Contains("full: holds files; a kit goes to an empty folder or a new one"));
  CHECK_THAT(refusal("file"), Contains("file: expected a folder, found a file"));
  CHECK_THAT(complaint<IoError>([&] { exportKit(folder.path() / "no" / "kit", cases); }), Contains("no/kit"));
  CHECK(filesBeside() == 2);
  CHECK(readBytes(folder.path() / "full" / "mine.txt") == "mine");

  KitOptions stopped;
  stopped.progress = [](const std::string&, double done) { return done < 0.5; };
  CHECK_FALSE(exportKit(folder.path() / "kit", cases, stopped).complete);
  CHECK(filesBeside() == 2);

  fs::create_directory(folder.path() / "kit");
  CHECK(exportKit(folder.path() / "kit/", cases).complete);
  CHECK(filesBeside() == 3);
  for (const char* file : {"README.md", "kit.json", "cases/single-voxel/case.json"})
    CHECK(fs::exists(folder.path() / "kit" / file));
}

TEST_CASE("A kit of a volume has its own view and those of a check, and refuses what it cannot say", "[check]") {
  const ScalarGrid grid = makeDense({20, 20, 20});
  Scene scene;
  scene.transfer = TransferFunction({{0.2, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.2, 0.6, 0.9}, 0.4}}});
  scene.camera.width = 24;
  scene.camera.height = 18;
  const auto resolve = [&](const Scene& given) { return resolveScene(given, grid.worldBounds(), grid.indexToWorld()); };
  const KitCase kit = kitCaseOf("my volume (1)", grid, resolve(scene));
  CHECK(kit.name == "my-volume-1");
  CHECK(kit.views.size() == 7);
  const KitFolder folder({kit});
  CHECK(folder.summary.pictures == 7);
  // A volume without bricks of its own gets the usual ones.
  CHECK(folder.input(kit.name).json["bricks"]["interior"][0] == 24);

  Scene clipped = scene, mip = scene;
  clipped.clipPlanes = {{1, 0, 0, 3}};
  mip.mode = Mode::mip;
  const auto refusal = [&](const Scene& given) {
    return complaint<InvalidArgument>([&] { kitCaseOf("x", grid, resolve(given)); });
  };
  CHECK_THAT(refusal(clipped), Contains("clip.planes"));
  CHECK_THAT(refusal(mip), Contains("mode: is mip"));
}
