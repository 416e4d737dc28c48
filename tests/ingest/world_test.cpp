// Volumes that are brought to another world.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/world.h"

#include <catch2/catch.hpp>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// 2 x 2 x 2 voxels, 2 x 3 x 4 apart, the first at (-30, -40, 5), in a space and a unit that the file names.
struct WorldFile {
  TemporaryFolder folder;
  fs::path write(const std::string& name, const std::string& space, const std::string& unit = "mm") const {
    writeBytes(folder.path() / "v.raw", std::string(8, '\1'));
    const std::string units = "space units: \"" + unit + "\" \"" + unit + "\" \"" + unit + "\"\n";
    writeBytes(folder.path() / name,
               "NRRD0004\ntype: uint8\ndimension: 3\n" +
                   (space.empty() ? "space dimension: 3\n" : "space: " + space + '\n') +
                   "sizes: 2 2 2\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (-30,-40,5)\n" +
                   (unit.empty() ? "" : units) + "encoding: raw\ndata file: v.raw\n");
    return folder.path() / name;
  }
};

OpenOptions inSpaceOf(const char* space) {
  OpenOptions options;
  options.space = space;
  return options;
}

glm::dvec3 placeOf(const VolumeInfo& info, const glm::dvec3& voxel) {
  return glm::dvec3(info.indexToWorld * glm::dvec4(voxel, 1));
}

}  // namespace

TEST_CASE("A volume is turned to the space that is asked for, and says so", "[ingest][world]") {
  const WorldFile file;
  const auto path = file.write("v.nhdr", "left-posterior-superior");
  const VolumeInfo own = openVolume(path)->info();
  CHECK(placeOf(own, {1, 1, 1}) == glm::dvec3(-28, -37, 9));
  for (const char* same : {"", "file", "LPS"}) {
    CHECK(openVolume(path, inSpaceOf(same))->info().indexToWorld == own.indexToWorld);
    CHECK(openVolume(path, inSpaceOf(same))->info().notes.empty());
  }
  const VolumeInfo ras = openVolume(path, inSpaceOf("RAS"))->info();
  CHECK(placeOf(ras, {1, 1, 1}) == glm::dvec3(28, 37, 9));
  CHECK(ras.metadata.at("space") == "RAS");
  CHECK_THAT(ras.notes.at(0), Contains("LPS to RAS"));
  CHECK_THROWS_WITH(openVolume(path, inSpaceOf("ras")), Contains("space: expected three letters") && Contains("ras"));
}

TEST_CASE("Numbers of a file that states no space are taken for the one that is asked for", "[ingest][world]") {
  const WorldFile file;
  const auto path = file.write("v.nhdr", "");
  const VolumeInfo ras = openVolume(path, inSpaceOf("RAS"))->info();
  CHECK(ras.indexToWorld == openVolume(path)->info().indexToWorld);
  CHECK(ras.metadata.at("space") == "RAS");
  CHECK_THAT(ras.notes.at(0), Contains("taken for RAS"));
  const auto other = file.write("scanner.nhdr", "scanner-xyz");
  CHECK_THROWS_WITH(openVolume(other, inSpaceOf("RAS")),
                    Contains("space: cannot turn to RAS") && Contains("scanner-xyz"));
}

TEST_CASE("A volume is brought to the world of another one as far as both state it", "[ingest][world]") {
  const WorldFile file;
  const World world{"RAS", "um", "that of first.nii"};
  const auto brought = inWorld(openVolume(file.write("v.nhdr", "left-posterior-superior")), world, true)->info();
  CHECK(placeOf(brought, {1, 1, 1}) == glm::dvec3(28000, 37000, 9000));
  CHECK(brought.metadata.at("space") == "RAS");
  CHECK(brought.metadata.at("length_unit") == "um");
  REQUIRE(brought.notes.size() == 2);
  CHECK_THAT(brought.notes[0], Contains("LPS to RAS, that of first.nii"));
  CHECK_THAT(brought.notes[1], Contains("um in place of mm"));

  const auto bare = inWorld(openVolume(file.write("bare.nhdr", "", "")), world, true)->info();
  CHECK(placeOf(bare, {1, 1, 1}) == glm::dvec3(-28, -37, 9));
  REQUIRE(bare.notes.size() == 2);
  CHECK_THAT(bare.notes[0], Contains("does not say which way its axes point") && Contains("RAS"));
  CHECK_THAT(bare.notes[1], Contains("states no unit of length"));
  CHECK(inWorld(openVolume(file.write("bare.nhdr", "", "")), world, false)->info().notes.empty());
  CHECK(inWorld(openVolume(file.write("v.nhdr", "left-posterior-superior")), {}, true)->info().notes.empty());
}

TEST_CASE("Spacing and origin take the place of those of a file only where that is asked for", "[ingest][world]") {
  const WorldFile file;
  const auto path = file.write("v.nhdr", "left-posterior-superior", "um");
  OpenOptions options;
  options.spacing = glm::dvec3(0.5, 0.25, 1);
  CHECK_THROWS_WITH(openVolume(path, options), Contains("NRRD states its own"));
  options.overridePlace = true;
  const VolumeInfo info = openVolume(path, options)->info();
  // The unit is that of the world, mm.
  CHECK(placeOf(info, {1, 1, 1}).x == Approx(-0.030 + 0.5).epsilon(1e-12));
  CHECK(info.indexToWorld[1] == glm::dvec4(0, 0.25, 0, 0));
  CHECK_THAT(info.notes.at(0), Contains("0.5 0.25 1 mm") && Contains("0.002 0.003 0.004"));
  options.lengthUnit = "um";
  options.spacing = std::nullopt;
  options.origin = glm::dvec3(1, 2, 3);
  const VolumeInfo moved = openVolume(path, options)->info();
  CHECK(placeOf(moved, {1, 1, 1}) == glm::dvec3(3, 5, 7));
  CHECK_THAT(moved.notes.at(0), Contains("1 2 3 um"));
  options.origin = glm::dvec3(0, std::nan(""), 0);
  CHECK_THROWS_WITH(openVolume(path, options), Contains("origin: expected finite numbers"));
}
