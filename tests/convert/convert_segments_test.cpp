// DICOM segmentations that are cropped, masked and turned as other labels are.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "ingest/dicom_segmentation.h"
#include "support/files.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::vector<Shown> kFrames{{2, 7.5}, {1, 0}, {1, 2.5}, {2, 0}, {1, 7.5}};

struct SegmentFile {
  DicomFolder files;
  fs::path path = files.folder.path() / "s.dcm", out = files.folder.path() / "o.vdb";
  explicit SegmentFile(bool fractional = false) { files.write("s.dcm", segmentation(kFrames, fractional)); }
};

ConvertOptions labelled() {
  ConvertOptions options;
  options.labels.emplace();
  options.verify = true;
  return options;
}

using Places = std::set<std::tuple<long, long, long>>;  // of the world, in micrometres

// Where the voxels of a segment lie by the frames, of those that `keep` keeps.
template <class Keep>
Places expected(int segment, const Keep& keep, double side = 1) {
  Places places;
  for (std::size_t i = 0; i < kFrames.size(); ++i)
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        if (kFrames[i].segment != segment || !isSet(i, x, y)) continue;
        if (!keep(x, y, std::lround(kFrames[i].place / 2.5))) continue;
        glm::dvec3 at = glm::dvec3(1, 2, 3) + kFrames[i].place * kNormal;
        for (int axis = 0; axis < 3; ++axis)
          at[axis] += x * 0.5 * kOrientation[std::size_t(axis)] + y * 0.75 * kOrientation[std::size_t(axis) + 3];
        places.emplace(std::lround(side * at.x * 1e3), std::lround(side * at.y * 1e3), std::lround(at.z * 1e3));
      }
  return places;
}

Places found(const fs::path& file, const std::string& name) {
  Places places;
  const auto grid = readScalarGrid(file, name).grid;
  for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d at = grid->indexToWorld(voxel.getCoord());
    places.emplace(std::lround(at.x() * 1e3), std::lround(at.y() * 1e3), std::lround(at.z() * 1e3));
  }
  return places;
}

}  // namespace

TEST_CASE("A segmentation is cropped, and each voxel stays where it is in the world", "[convert]") {
  const SegmentFile file;
  ConvertOptions options = labelled();
  options.source.crop = {{2, 1, 1}, {8, 7, 3}};
  const ConvertReport report = convert({file.path}, file.out, options);
  const auto inside = [](int x, int y, long z) { return x >= 2 && x <= 8 && y >= 1 && y <= 7 && z >= 1 && z <= 3; };
  for (const auto& [segment, name] : {std::pair(1, "liver"), std::pair(2, "vessel")}) {
    CHECK(found(file.out, name) == expected(segment, inside));
    CHECK(report.grids.at(std::size_t(segment) - 1).verified->beyond == 0);
  }
  options.source.crop = {{0, 0, 0}, {0, 0, 4}};
  CHECK_THROWS_AS(convert({file.path}, file.out, options), OptionsError);
  CHECK_THROWS_WITH(convert({file.path}, file.out, options), Contains("crop: expected first and last voxel inside"));
}

TEST_CASE("A segmentation is turned to another space, and beside another input to the world of that", "[convert]") {
  const SegmentFile file;
  const auto all = [](int, int, long) { return true; };
  ConvertOptions options = labelled();
  options.source.open.space = "RAS";
  convert({file.path}, file.out, options);
  CHECK(found(file.out, "vessel") == expected(2, all, -1));
  CHECK(readScalarGrid(file.out, "vessel").metadata("space") == "RAS");
  options.source.open.space = "file";
  convert({file.path}, file.out, options);
  CHECK(found(file.out, "vessel") == expected(2, all));
  const fs::path first = file.files.folder.path() / "first.seg.nrrd";
  writeBytes(first,
             "NRRD0004\ntype: uchar\ndimension: 3\nspace: right-anterior-superior\nsizes: 2 1 1\nencoding: raw\n"
             "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n\1\1");
  convert({first, file.path}, file.out, labelled());
  CHECK(found(file.out, "liver") == expected(1, all, -1));
}

TEST_CASE("A mask leaves voxels of all segments out, fractional or not, and counts them", "[convert]") {
  for (const bool fractional : {false, true}) {
    const SegmentFile file(fractional);
    // The mask is a segmentation of one segment, which is a volume: of the five frames it keeps three and empties two.
    file.files.write("m.dcm", segmentation({{1, 7.5}, {1, 0}, {1, 2.5}, {1, 5}}));
    ConvertOptions options = labelled();
    options.source.mask = file.files.folder.path() / "m.dcm";
    const ConvertReport report = convert({file.path}, file.out, options);
    const auto kept = [](int x, int y, long z) { return isSet(std::size_t(z + 1) % 4, x, y); };
    std::size_t before = 0, after = 0;
    for (const auto& [segment, name] : {std::pair(1, "liver"), std::pair(2, "vessel")}) {
      const Places places = found(file.out, name);
      CHECK_FALSE(places.empty());
      CHECK(places == expected(segment, kept));
      after += places.size();
      before += expected(segment, [](int, int, long) { return true; }).size();
    }
    CHECK(report.grids.at(0).masked == before - after);
    CHECK(before > after);
  }
}

TEST_CASE("What segments have no use for is refused in one line", "[convert]") {
  const SegmentFile file;
  ConvertOptions options = labelled();
  options.source.open.spacing = glm::dvec3(1);
  CHECK_THROWS_WITH(convert({file.path}, file.out, options),
                    Contains("source.open.spacing is not for segments of a DICOM segmentation"));
  options = labelled();
  options.source.resample = glm::dvec3(1);
  CHECK_THROWS_WITH(convert({file.path}, file.out, options), Contains("source.resample is not for grids of labels"));
}
