// Volumes of several numbers a voxel, of several frames, and of labels.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/convert_frames.h"
#include "umbrick/convert/load_volume.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/read_vectors.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr int kPartEdge = 10;

// The number of a component at a place; most places are empty.
float partNumber(int x, int y, int z, int component, int frame) {
  return x + y + z < 8 ? 0.0f : static_cast<float>(x + 10 * y - 5 * z + 100 * component + 1000 * frame);
}

// A NRRD of floats: components are the fastest axis, frames the slowest.
fs::path writeParts(const TemporaryFolder& folder, int components, int frames, const std::string& encoding = "raw",
                    const std::string& kind = "vector") {
  std::vector<float> numbers;
  for (int f = 0; f < frames; ++f)
    for (int z = 0; z < kPartEdge; ++z)
      for (int y = 0; y < kPartEdge; ++y)
        for (int x = 0; x < kPartEdge; ++x)
          for (int c = 0; c < components; ++c) numbers.push_back(partNumber(x, y, z, c, f));
  const std::string edge = std::to_string(kPartEdge), axes = ' ' + edge + ' ' + edge + ' ' + edge;
  const std::string head = "NRRD0005\ntype: float\nendian: little\nencoding: " + encoding +
                           "\ndimension: 5\nsizes: " + std::to_string(components) + axes + ' ' +
                           std::to_string(frames) + "\nkinds: " + kind + " domain domain domain time\n\n";
  writeBytes(folder.path() / "v.nrrd", head + (encoding == "gzip" ? gzipped(bytesOf(numbers)) : bytesOf(numbers)));
  return folder.path() / "v.nrrd";
}

void checkScalars(const openvdb::FloatGrid& grid, int component, int frame) {
  std::size_t wrong = 0;
  for (int z = 0; z < kPartEdge; ++z)
    for (int y = 0; y < kPartEdge; ++y)
      for (int x = 0; x < kPartEdge; ++x)
        wrong += grid.tree().getValue({x, y, z}) != partNumber(x, y, z, component, frame);
  CHECK(wrong == 0);
}

void checkVectors(const fs::path& file, const std::string& name, int frame) {
  const auto grid = readVectorGrid(file, name);
  std::size_t wrong = 0;
  for (int z = 0; z < kPartEdge; ++z)
    for (int y = 0; y < kPartEdge; ++y)
      for (int x = 0; x < kPartEdge; ++x)
        for (int c = 0; c < 3; ++c) wrong += grid->tree().getValue({x, y, z})[c] != partNumber(x, y, z, c, frame);
  CHECK(wrong == 0);
  for (int c = 0; c < 3; ++c) checkScalars(*vectorComponent(*grid, c).grid, c, frame);
  const auto lengths = vectorComponent(*grid, std::nullopt).grid;
  CHECK(lengths->tree().getValue({9, 9, 9}) == Approx(grid->tree().getValue({9, 9, 9}).length()));
  CHECK(lengths->activeVoxelCount() == grid->activeVoxelCount());
}

std::vector<std::string> gridNamesIn(const fs::path& file) {
  std::vector<std::string> names;
  for (const GridListing::Row& row : listGrids(file).grids) names.push_back(row.label + ' ' + row.type);
  return names;
}

}  // namespace

TEST_CASE("Three numbers a voxel become a grid of vec3 that is verified, others a grid of each", "[convert]") {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "o.vdb", input = writeParts(folder, 3, 1);
  ConvertOptions options;
  options.verify = true;
  const ConvertReport report = convert({input}, out, options);
  CHECK(gridNamesIn(out) == std::vector<std::string>{"v vec3s"});
  checkVectors(out, "v", 0);
  CHECK(report.grids.at(0).verified->error.max == 0);
  CHECK(report.grids.at(0).notes.front() == "voxels of three numbers, a vector, become the grid of vec3 \"v\"");
  options.names = {"vel"};
  convert({input}, out, options);
  CHECK(gridNamesIn(out) == std::vector<std::string>{"vel vec3s"});
  options.names.clear();
  options.eachComponent = true;
  const ConvertReport each = convert({input}, out, options);
  CHECK(each.grids.size() == 3);
  CHECK(each.bytesIn == std::int64_t(fs::file_size(input)));
  CHECK(each.grids.at(0).notes.size() == 1);
  CHECK(each.grids.at(1).notes.empty());
  CHECK(gridNamesIn(out) == std::vector<std::string>{"v_0 float", "v_1 float", "v_2 float"});
  checkScalars(*readScalarGrid(out, "v_2").grid, 2, 0);
  options.eachComponent = false;
  options.source.open.parts.component = 1;
  convert({input}, folder.path() / "o.nvdb", options);
  checkScalars(*readScalarGrid(folder.path() / "o.nvdb").grid, 1, 0);
  options.source.open.parts = {};
  convert({writeParts(folder, 2, 1)}, out, options);
  CHECK(gridNamesIn(out) == std::vector<std::string>{"v_0 float", "v_1 float"});
  convert({writeParts(folder, 4, 1, "raw", "RGBA-color")}, out, options);
  CHECK(gridNamesIn(out) == std::vector<std::string>{"Cd_r float", "Cd_g float", "Cd_b float", "Cd_a float"});
}

// They share one pass over the file, in which they are cut and resampled as they are one by one.
TEST_CASE("A grid of each component is the one that the component alone becomes", "[convert]") {
  const TemporaryFolder folder;
  const fs::path all = folder.path() / "all.vdb", alone = folder.path() / "alone.vdb";
  for (const char* encoding : {"raw", "gzip"})
    for (const int what : {0, 1, 2, 3}) {
      CAPTURE(encoding, what);
      const fs::path input = writeParts(folder, 3, 1, encoding);
      ConvertOptions options;
      options.verify = true;
      if (what == 1) options.source.crop = {{1, 2, 3}, {8, 9, 7}};
      if (what == 2) options.source.resample = glm::dvec3(2);
      if (what == 3) options.build.maxError = 3;
      options.eachComponent = true;
      const ConvertReport together = convert({input}, all, options);
      options.eachComponent = false;
      REQUIRE(together.grids.size() == 3);
      for (int c = 0; c < 3; ++c) {
        options.source.open.parts.component = c;
        const ConvertedGrid single = convert({input}, alone, options).grids.at(0);
        const ConvertedGrid& shared = together.grids.at(static_cast<std::size_t>(c));
        CHECK(shared.build.activeVoxels == single.build.activeVoxels);
        CHECK(shared.build.maxError == single.build.maxError);
        CHECK(shared.build.storage == single.build.storage);
        const ScalarGrid a = readScalarGrid(all, "v_" + std::to_string(c)), b = readScalarGrid(alone);
        CHECK(a.grid->tree().hasSameTopology(b.grid->tree()));
        CHECK(a.indexToWorld() == b.indexToWorld());
        std::size_t wrong = 0;
        for (auto value = a.grid->cbeginValueAll(); value; ++value)
          wrong += *value != b.grid->tree().getValue(value.getCoord());
        CHECK(wrong == 0);
      }
    }
}

TEST_CASE("What a grid of vec3 has no use for is refused in one line", "[convert]") {
  const TemporaryFolder folder;
  const fs::path input = writeParts(folder, 3, 1), out = folder.path() / "o.vdb";
  const auto refused = [&](const ConvertOptions& options, const fs::path& output, const std::string& what) {
    CHECK_THROWS_AS(convert({input}, output, options), OptionsError);
    CHECK_THROWS_WITH(convert({input}, output, options), Contains(what));
    CHECK_FALSE(fs::exists(output));
  };
  ConvertOptions options;
  refused(options, folder.path() / "o.nvdb", "expected a .vdb for a grid of vec3");
  refused(options, folder.path() / "o.mhd", "expected a .vdb for a grid of vec3");
  options.build.half = true;
  refused(options, out, "build.half is not for a grid of vec3: choose one of its numbers by");
  options.build.half = false;
  options.source.mask = input;
  refused(options, out, "source.mask is not for a grid of vec3");
  options.source.mask.clear();
  options.eachComponent = true;
  refused(options, folder.path() / "o.mhd", "expected one grid for .mhd, found 3");
  // A part of it is taken as of any volume.
  options.eachComponent = false;
  options.verify = true;
  options.source.crop = {{2, 3, 4}, {8, 8, 8}};
  convert({input}, out, options);
  const auto grid = readVectorGrid(out, "v");
  CHECK(grid->tree().getValue({0, 0, 0})[1] == partNumber(2, 3, 4, 1, 0));
  CHECK(grid->transform().indexToWorld(openvdb::Vec3d(0)) == openvdb::Vec3d(2, 3, 4));
}

TEST_CASE("Frames of one file become a file each, packed or not", "[convert]") {
  const TemporaryFolder folder;
  for (const char* encoding : {"raw", "gzip"})
    for (const int components : {1, 2, 3}) {
      CAPTURE(encoding, components);
      const fs::path input = writeParts(folder, components, 5, encoding);
      ConvertOptions options;
      options.verify = true;
      const FrameSequence sequence = findFramesInside(input, folder.path() / "o%02d.vdb", FrameRange{1, 9, 2}, options);
      REQUIRE(sequence.frames.size() == 2);
      CHECK(sequence.missing.size() == 1);
      std::vector<std::int64_t> written;
      convertFrames(sequence.frames, options, [&](const FrameFiles& frame, const ConvertReport& report) {
        written.push_back(frame.number);
        CHECK(report.grids.size() == (components == 2 ? 2u : 1u));
        const int number = static_cast<int>(frame.number);
        if (components == 3) return checkVectors(frame.output, "v", number);
        for (int c = 0; c < components; ++c)
          checkScalars(*readScalarGrid(frame.output, components == 1 ? "density" : "v_" + std::to_string(c)).grid, c,
                       number);
      });
      CHECK(written == std::vector<std::int64_t>{1, 3});
    }
  const fs::path input = writeParts(folder, 1, 5);
  CHECK_THROWS_WITH(convert({input}, folder.path() / "o.vdb"), Contains("a sequence of 5 volumes, frame 0 to 4"));
  ConvertOptions options;
  options.source.open.parts.frame = 4;
  convert({input}, folder.path() / "o.vdb", options);
  checkScalars(*readScalarGrid(folder.path() / "o.vdb").grid, 0, 4);
  checkScalars(*loadVolume(input, options).grid.grid, 0, 4);
  CHECK_THROWS_WITH(findFramesInside(input, folder.path() / "o%d.vdb", FrameRange{7, 9}),
                    Contains("expected some of its frames 0-4, found frames 7-9"));
}

TEST_CASE("Labels become grids of their names that are verified", "[convert]") {
  const TemporaryFolder folder;
  std::string voxels(10 * 10 * 10, '\0');
  for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<char>(i % 7 == 0 ? 2 : i > 500 ? 5 : 0);
  const fs::path input = folder.path() / "v.seg.nrrd", out = folder.path() / "o.vdb";
  writeBytes(input,
             "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 10 10 10\nencoding: raw\nSegment0_Name:=liver\n"
             "Segment0_LabelValue:=5\nSegment0_Color:=1 0 0.5\n\n" +
                 voxels);
  ConvertOptions options;
  options.verify = true;
  options.labels.emplace();
  const ConvertReport report = convert({input}, out, options);
  CHECK(gridNamesIn(out) == std::vector<std::string>{"liver float", "label_2 float"});
  CHECK(report.grids.at(0).volumeLabel->value == 5);
  CHECK(report.grids.at(0).verified->voxels == 1000);
  CHECK(readScalarGrid(out, "label_2").grid->activeVoxelCount() == 143);
  CHECK(readScalarGrid(out, "liver").metadata("label_name") == "liver");
  options.labels->wanted = {"2"};
  convert({input}, folder.path() / "o.nvdb", options);
  CHECK(readScalarGrid(folder.path() / "o.nvdb").grid->activeVoxelCount() == 143);
  options.build.tolerance = 0.5f;
  CHECK_THROWS_WITH(convert({input}, out, options), Contains("build.tolerance is not for grids of labels"));
}
