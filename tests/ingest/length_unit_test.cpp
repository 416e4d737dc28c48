// The unit of length of the world.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

struct UnitFile {
  TemporaryFolder folder;
  fs::path path = folder.path() / "v.nhdr";
  void write(const std::string& spacing, const std::string& unit,
             const std::string& bytes = std::string(8, '\1')) const {
    writeBytes(folder.path() / "v.raw", bytes);
    writeBytes(path, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: " + spacing + ' ' + spacing + ' ' +
                         spacing + (unit.empty() ? "" : "\nunits: \"" + unit + "\" \"" + unit + "\" \"" + unit + '"') +
                         "\nencoding: raw\ndata file: v.raw\n");
  }
  VolumeInfo info(const std::string& unit = {}) const {
    OpenOptions options;
    options.lengthUnit = unit;
    return openVolume(path, options)->info();
  }
  void check(const std::string& asked, double spacing, const std::string& unit) const {
    const VolumeInfo found = info(asked);
    CHECK(found.indexToWorld[0][0] == spacing);
    CHECK(found.indexToWorld[2][2] == spacing);
    CHECK(found.metadata.at("length_unit") == unit);
  }
};

}  // namespace

// 5 nm are 5e-6 mm, and OpenVDB refuses voxels of less than 3e-15 cubed world units, an edge of 1.4e-5.
TEST_CASE("Voxels that OpenVDB cannot hold in mm are in the unit of the file, or a smaller one", "[ingest]") {
  const UnitFile file;
  file.write("5", "nm");
  file.check("", 5, "nm");
  CHECK_THAT(file.info().notes.at(0), Contains("the unit of length is nm"));
  file.write("0.005", "um");
  file.check("", 0.005, "um");
  file.write("0.000005", "mm");
  file.check("", 0.005, "um");
  file.write("5e-9", "m");
  CHECK(file.info().metadata.at("length_unit") == "um");
  file.write("20", "nm");  // fits
  CHECK(file.info().indexToWorld[0][0] == Approx(20e-6));
  CHECK(file.info().metadata.at("length_unit") == "mm");
  CHECK(file.info().notes.empty());
}

TEST_CASE("The unit of length is the one that is asked for", "[ingest]") {
  const UnitFile file;
  file.write("5", "nm");
  file.check("nm", 5, "nm");
  file.check("file", 5, "nm");
  file.check("um", 0.005, "um");
  CHECK(file.info("um").notes.empty());
  file.write("0.25", "um");
  file.check("nm", 250, "nm");
  file.check("file", 0.25, "um");
  file.check("mm", 0.25e-3, "mm");
  CHECK(file.info("m").indexToWorld[0][0] == Approx(0.25e-6));
  file.write("0.25", "");
  file.check("nm", 0.25, "nm");
  CHECK_THAT(file.info("nm").notes.at(0), Contains("states no unit of length: its numbers are taken for nm"));
  CHECK_FALSE(file.info("file").metadata.contains("length_unit"));
  CHECK_THROWS_WITH(file.info("ell"), Contains("length unit: expected nm, um, mm, cm, m or file, found \"ell\""));
}

TEST_CASE("Voxels that are too small in no stated unit are counted in a part of it", "[ingest]") {
  const UnitFile file;
  file.write("1e-9", "");
  CHECK(file.info().indexToWorld[0][0] == Approx(1e-3));
  CHECK(file.info().metadata.at("length_unit") == "1e-6 of the file's unit");
  CHECK_THAT(file.info().notes.at(0), Contains("too small for OpenVDB"));
}

TEST_CASE("A data file that is longer than its detached header says is noted, or refused when strict", "[ingest]") {
  const UnitFile file;
  const std::string voxels = "abcdefgh";
  file.write("1", "mm", voxels + "rest");
  OpenOptions strict;
  strict.strict = true;
  const fs::path mhd = file.folder.path() / "v.mhd";
  writeBytes(mhd, "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = v.raw\n");
  for (const fs::path& path : {file.path, mhd}) {
    const auto source = openVolume(path);
    REQUIRE(source->info().notes.size() == 1);
    CHECK(source->info().notes[0] == "v.raw has 4 bytes behind its voxels, which are left out");
    CHECK(readVolume(*source) == std::vector<float>(voxels.begin(), voxels.end()));
    CHECK_THROWS_WITH(openVolume(path, strict), Contains("expected 8 bytes of u8 voxels, found 12"));
  }
  file.write("1", "mm", "abcdefg");
  CHECK_THROWS_AS(openVolume(file.path), IoError);
}
