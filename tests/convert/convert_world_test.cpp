// Several inputs, masks and outputs whose worlds differ.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// The same 3 x 2 x 2 voxels at the same places of a patient, in two spaces; the second in other indices, as NIfTI
// writers have them.
struct Patient {
  TemporaryFolder folder;
  fs::path lps = write("lps.nrrd", "left-posterior-superior", "(2,0,0) (0,2,0) (0,0,3)", "(-30,-40,5)");
  fs::path ras = write("ras.nrrd", "right-anterior-superior", "(-2,0,0) (0,-2,0) (0,0,3)", "(30,40,5)");
  fs::path bare = write("bare.nrrd", "", "(2,0,0) (0,2,0) (0,0,3)", "(-30,-40,5)");

  fs::path write(const char* name, const std::string& space, const std::string& axes, const std::string& origin,
                 const std::string& voxels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) const {
    writeBytes(folder.path() / name, "NRRD0004\ntype: uint8\ndimension: 3\n" +
                                         (space.empty() ? "space dimension: 3" : "space: " + space) +
                                         "\nsizes: 3 2 2\nspace directions: " + axes + "\nspace origin: " + origin +
                                         "\nencoding: raw\n\n" + voxels);
    return folder.path() / name;
  }
  openvdb::Vec3d placeOf(const fs::path& file, const std::string& grid, const openvdb::Coord& at = {2, 1, 1}) const {
    return readScalarGrid(file, grid).grid->indexToWorld(at);
  }
};

const openvdb::Vec3d kLastVoxel(-26, -38, 8);  // in LPS

}  // namespace

TEST_CASE("Several inputs are brought to the world of the first", "[convert][world]") {
  const Patient patient;
  const auto out = patient.folder.path() / "both.vdb";
  ConvertOptions options;
  options.verify = true;
  const ConvertReport report = convert({patient.lps, patient.ras, patient.bare}, out, options);
  CHECK(patient.placeOf(out, "lps") == kLastVoxel);
  CHECK(patient.placeOf(out, "ras") == kLastVoxel);
  CHECK(report.grids[0].notes.empty());
  CHECK_THAT(report.grids[1].notes.at(0), Contains("RAS to LPS") && Contains("lps.nrrd"));
  CHECK_THAT(report.grids[2].notes.at(0), Contains("does not say which way its axes point"));

  convert({patient.ras, patient.lps}, out, options);
  CHECK(patient.placeOf(out, "lps") == openvdb::Vec3d(26, 38, 8));
  options.source.open.space = "LPS";
  convert({patient.ras, patient.lps}, out, options);
  CHECK(patient.placeOf(out, "ras") == kLastVoxel);
  CHECK(patient.placeOf(out, "lps") == kLastVoxel);
}

TEST_CASE("A mask is brought to the world of its volume, be they files of volumes or of grids", "[convert][world]") {
  const Patient patient;
  const auto mask = patient.write("mask.nrrd", "right-anterior-superior", "(-2,0,0) (0,-2,0) (0,0,3)", "(30,40,5)",
                                  {1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0});
  const auto out = patient.folder.path() / "out.vdb";
  const auto gridMask = patient.folder.path() / "mask.vdb", grid = patient.folder.path() / "grid.vdb";
  convert({mask}, gridMask);
  convert({patient.lps}, grid);
  for (const fs::path& input : {patient.lps, grid})
    for (const fs::path& by : {mask, gridMask}) {
      CAPTURE(input, by);
      ConvertOptions options;
      options.source.mask = by;
      options.verify = true;
      const ConvertReport report = convert({input}, out, options);
      CHECK(report.grids.front().masked == 6);
      CHECK(readScalarGrid(out).grid->activeVoxelCount() == 6);
      REQUIRE(report.grids.front().notes.size() == 1);
      CHECK_THAT(report.grids.front().notes.front(), Contains("mask") && Contains("RAS to LPS"));
    }
  ConvertOptions moved;
  moved.source.mask = patient.write("moved.nrrd", "right-anterior-superior", "(2,0,0) (0,2,0) (0,0,3)", "(30,40,5)");
  CHECK_THROWS_WITH(convert({patient.lps}, out, moved), Contains("position of voxel"));
}

TEST_CASE("A MetaImage is written in LPS and a NRRD in the space of the grid", "[convert][world]") {
  const Patient patient;
  const auto mhd = patient.folder.path() / "out.mhd", nrrd = patient.folder.path() / "out.nrrd";
  ConvertOptions options;
  options.verify = true;
  const ConvertReport turned = convert({patient.ras}, mhd, options);
  CHECK_THAT(turned.notes.at(0), Contains("LPS") && Contains("RAS"));
  const VolumeInfo written = openVolume(mhd)->info();
  CHECK(glm::dvec3(written.indexToWorld[3]) == glm::dvec3(-30, -40, 5));
  CHECK(glm::dmat3(written.indexToWorld) == glm::dmat3(2, 0, 0, 0, 2, 0, 0, 0, 3));
  CHECK(convert({patient.lps}, mhd, options).notes.empty());
  CHECK(openVolume(mhd)->info().indexToWorld == written.indexToWorld);
  CHECK(convert({patient.bare}, mhd, options).notes.empty());

  CHECK(convert({patient.ras}, nrrd, options).notes.empty());
  CHECK(openVolume(nrrd)->info().metadata.at("space") == "RAS");
  options.source.open.space = "LSA";  // a NRRD has no word for it
  CHECK_THAT(convert({patient.ras}, nrrd, options).notes.at(0), Contains("LPS") && Contains("LSA"));
  CHECK(openVolume(nrrd)->info().indexToWorld == written.indexToWorld);
  CHECK_THAT(convert({patient.ras}, patient.folder.path() / "out.nvdb").notes.at(0), Contains("RAS"));
}

TEST_CASE("Grids of a file are turned to the space that is asked for", "[convert][world]") {
  const Patient patient;
  const auto ras = patient.folder.path() / "ras.vdb", out = patient.folder.path() / "out.vdb";
  convert({patient.ras}, ras);
  ConvertOptions options;
  options.source.open.space = "LPS";
  options.verify = true;
  const ConvertReport report = convert({ras}, out, options);
  CHECK(patient.placeOf(out, "density") == kLastVoxel);
  CHECK_THAT(report.grids.front().notes.at(0), Contains("RAS to LPS"));
  options.source.open.space = "LPX";
  CHECK_THROWS_AS(convert({ras}, out, options), OptionsError);
}
