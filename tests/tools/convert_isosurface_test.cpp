// The surface of a value as a level set, as a user makes it.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"
#include "tools/refusal.h"
#include "umbrick/image/exr.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// 40^3 voxels of u8: 100 at a radius of `radius` from the middle, 10 more for each voxel inwards.
void writeBall(const TemporaryFolder& folder, const std::string& name, double radius) {
  std::string voxels;
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double r = std::sqrt((x - 19.5) * (x - 19.5) + (y - 19.5) * (y - 19.5) + (z - 19.5) * (z - 19.5));
        voxels += static_cast<char>(static_cast<unsigned char>(std::clamp(100 + 10 * (radius - r), 0.0, 255.0)));
      }
  writeBytes(folder.path() / name,
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 40 40 40\nspacings: 0.5 0.5 0.5\n"
             "encoding: raw\n\n" +
                 voxels);
}

}  // namespace

TEST_CASE("An isosurface is a level set that info knows and pictures show", "[tools]") {
  const TemporaryFolder folder;
  writeBall(folder, "ball.nrrd", 12);
  const ProgramResult result = runProgram(folder, "convert ball.nrrd --isosurface 99.5 --half-width 4 -o ball.vdb");
  CHECK(result.status == 0);
  CHECK_THAT(result.out, Contains("level set       at 99.5, voxels 0.5 apart; ") && Contains("off by          0.0"));
  const nlohmann::json grid = nlohmann::json::parse(runProgram(folder, "info ball.vdb --json").out).at("grids").at(0);
  CHECK(grid.at("class") == "level set");
  CHECK(grid.at("name") == "density");
  CHECK(grid.at("background") == 2);
  CHECK(grid.at("metadata").at("isosurface_value") == "99.5");
  CHECK(grid.at("metadata").at("source_file") == "ball.nrrd");
  CHECK(grid.at("values").at("min") > -2);
  CHECK(grid.at("values").at("min") < -1.5);
  // What is active is a shell of 8 voxels around a radius of 12: 4/3 pi (16^3 - 8^3), and the voxels it ends in.
  CHECK(grid.at("active_voxels") == Approx(15011).epsilon(0.1));

  // Opaque inside, up to a tenth of a voxel: a disk whose share of the picture says how large the ball is.
  writeBytes(folder.path() / "solid.json", R"({"points": [{"value": -0.05, "albedo": [1, 1, 1], "sigma_t": 1000},
                                                          {"value": 0.05, "albedo": [1, 1, 1], "sigma_t": 0}]})");
  const ProgramResult picture = runProgram(
      folder,
      "reference ball.vdb --tf solid.json --model emission --orthographic --up 0 1 0 --eye 9.75 9.75 40 --look-at 9.75 "
      "9.75 9.75 --view-height 16 --size 64x64 -o ball.exr");
  INFO(picture.err);
  REQUIRE(picture.status == 0);
  const Image image = readExr(folder.path() / "ball.exr").layers.at(0).image;
  double disk = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) disk += double(image.at(x, y)[3]) * (16.0 / 64) * (16.0 / 64);
  // Radius 6, to two tenths of a voxel of 0.5; pixels of half of one on its edge.
  CHECK(std::sqrt(disk / 3.14159265) == Approx(6).margin(0.1));

  // Of a grid too.
  CHECK(runProgram(folder, "convert ball.nrrd -o fog.vdb").status == 0);
  CHECK_THAT(runProgram(folder, "convert fog.vdb --isosurface 99.5 -o fog_ls.vdb").out,
             Contains("level set       at 99.5"));
  CHECK_THAT(runProgram(folder, "info fog_ls.vdb").out, Contains("class          level set"));
}

TEST_CASE("Frames become level sets", "[tools]") {
  const TemporaryFolder folder;
  writeBall(folder, "b1.nrrd", 8);
  writeBall(folder, "b2.nrrd", 10);
  const ProgramResult result = runProgram(folder, "convert b%d.nrrd --isosurface 99.5 -o o%d.vdb");
  CHECK(result.status == 0);
  CHECK_THAT(result.out, Contains("o2.vdb: ") && Contains(" voxels active, level set off by 0.0"));
}

TEST_CASE("Isosurfaces that cannot be, and options that mean nothing for one, are refused", "[tools]") {
  const TemporaryFolder folder;
  writeBall(folder, "ball.nrrd", 12);
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    expectRefusal(folder, "convert ball.nrrd -o o.vdb --isosurface " + arguments, status, message);
  };
  for (const char* option : {"--tolerance 1", "--half", "--step 1", "--max-error 1", "--threshold 3", "--clip-below 3",
                             "--range 3 4", "--plan", "--verify"})
    refused(std::string("99.5 ") + option, 2, "--isosurface");
  refused("nan", 2, "--isosurface");
  CHECK(runProgram(folder, "convert ball.nrrd -o o.nvdb --isosurface 99.5 --quantise 8").status == 2);
  refused("99.5 --half-width 0.5", 2, "--half-width");
  refused("0", 1, "ball.nrrd: grid \"density\": isosurface: expected a value above the background of 0");
  refused("99.5 --background 100", 1, "above the background of 100, which is outside, found 99.5");
  refused("254", 1, "expected a value that the volume crosses, from 0 to 211, found 254");
  CHECK(runProgram(folder, "convert ball.nrrd -o o.vdb --half-width 3").status == 2);
}
