// Grids of vec3 and of labels that are made ready for other programs.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/read_vectors.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const openvdb::Coord kLast(2, 1, 1);

// 3 x 2 x 2 voxels of 2, 3 and 4 mm. The vector of each is the way from the first one to it, in mm of the file's world.
struct WayFile {
  TemporaryFolder folder;
  fs::path out = folder.path() / "out.vdb";
  fs::path write(const std::string& space, const std::string& kind = "vector") const {
    std::vector<float> numbers;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
          for (const int step : {2 * x, 3 * y, 4 * z}) numbers.push_back(static_cast<float>(step));
    const fs::path path = folder.path() / "in.nrrd";
    writeBytes(path, "NRRD0005\ntype: float\ndimension: 4\nspace: " + space +
                         "\nsizes: 3 3 2 2\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\nspace origin: (-30,-40,5)\n"
                         "space units: \"mm\" \"mm\" \"mm\"\nkinds: " +
                         kind + " domain domain domain\nencoding: raw\nendian: little\n\n" + bytesOf(numbers));
    return path;
  }
};

ConvertOptions readyFor(Target target) {
  ConvertOptions options;
  options.output.target = target;
  options.verify = true;
  return options;
}

}  // namespace

// Vectors that are ways between voxels must stay ways between the same voxels, whichever way the axes turn and whatever
// the unit is: the place of the grid and its vectors are computed apart.
TEST_CASE("Vectors turn and grow with the world of each target", "[convert][target]") {
  const WayFile file;
  for (const char* space : {"left-posterior-superior", "right-anterior-superior", "left-anterior-superior"})
    for (const auto& [target, name] :
         {std::pair(Target::blender, "velocity"), std::pair(Target::houdini, "vel"),
          std::pair(Target::unreal, "velocity"), std::pair(Target::omniverse, "velocity")}) {
      CAPTURE(space, name);
      const ConvertReport report = convert({file.write(space)}, file.out, readyFor(target));
      const auto grid = readVectorGrid(file.out, name);
      const openvdb::Vec3d first = grid->indexToWorld(openvdb::Coord(0));
      for (const openvdb::Coord& at :
           {kLast, openvdb::Coord(2, 0, 0), openvdb::Coord(0, 1, 0), openvdb::Coord(0, 0, 1)}) {
        const openvdb::Vec3d way = grid->indexToWorld(at) - first, vector(grid->tree().getValue(at));
        CHECK((way - vector).length() <= 1e-6 * way.length());  // floats have 24 bits
      }
      CHECK(grid->getVectorType() == openvdb::VEC_CONTRAVARIANT_RELATIVE);
      CHECK(grid->metaValue<std::string>("made_for").size() > 0);
      // Rounding twice to floats is the only loss.
      CHECK(report.grids.at(0).verified->error.max <= 4 * 0x1p-24);
      CHECK(report.grids.at(0).label == name);
      CHECK_THAT(report.notes.at(0), Contains("grid \"v\" is called " + std::string(name)));
    }
}

TEST_CASE("The unit of vectors says whether they are velocities, and of which length", "[convert][target]") {
  const WayFile file;
  const fs::path input = file.write("left-posterior-superior");
  struct Case {
    std::string unit, now, name;
    double factor;
    std::string note;
  };
  for (const Case& each : std::vector<Case>{
           {"", "", "velocity", 1e-3, "taken for lengths in mm, per time or not, and multiplied by 0.001"},
           {"mm/s", "m/s", "velocity", 1e-3, "multiplied by 0.001, from mm/s to m/s"},
           {"cm s-1", "m s-1", "velocity", 1e-2, "multiplied by 0.01, from cm s-1 to m s-1"},
           {"m/s", "m/s", "velocity", 1, "keep their lengths, in m/s"},
           {"um", "m", "v", 1e-6, "multiplied by 1e-06, from um to m"},
           {"T", "T", "v", 1, "keep their lengths, in T"},
           {"mm Hg", "mm Hg", "v", 1, "keep their lengths, in mm Hg"}}) {
    CAPTURE(each.unit);
    ConvertOptions options = readyFor(Target::blender);
    if (!each.unit.empty()) options.units = {each.unit};
    const ConvertReport report = convert({input}, file.out, options);
    const auto grid = readVectorGrid(file.out, each.name);
    CHECK(grid->tree().getValue(kLast)[0] == Approx(4 * each.factor));
    CHECK(grid->tree().getValue(kLast)[2] == Approx(4 * each.factor));
    if (!each.now.empty()) CHECK(grid->metaValue<std::string>("value_unit") == each.now);
    if (each.factor != 1) CHECK(grid->metaValue<double>("vector_scale") == Approx(each.factor));
    CHECK(std::any_of(report.grids.at(0).notes.begin(), report.grids.at(0).notes.end(),
                      [&](const std::string& note) { return note.find(each.note) != std::string::npos; }));
  }
  // A name that was given stays, and so does a background that is turned.
  ConvertOptions named = readyFor(Target::houdini);
  named.names = {"field"};
  named.build.background = 0.1f;
  convert({input}, file.out, named);
  const auto grid = readVectorGrid(file.out, "field");
  CHECK(grid->background()[2] == -grid->background()[0]);
  CHECK(grid->background()[0] == Approx(1e-4));
}

TEST_CASE("Colours keep their numbers and axes, as half floats where the target takes 0 to 1", "[convert][target]") {
  const TemporaryFolder folder;
  const fs::path input = folder.path() / "in.nrrd", out = folder.path() / "out.vdb";
  writeBytes(input,
             "NRRD0005\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: 3 2 1 1\n"
             "space directions: none (2,0,0) (0,3,0) (0,0,4)\nkinds: RGB-color domain domain domain\nencoding: raw\n\n"
             "\x10\x20\xff\x01\x02\x03");
  for (const auto& [target, name, halves] :
       {std::tuple(Target::blender, "color", true), std::tuple(Target::houdini, "Cd", false),
        std::tuple(Target::unreal, "color", true), std::tuple(Target::omniverse, "color", true)}) {
    const ConvertReport report = convert({input}, out, readyFor(target));
    const auto grid = readVectorGrid(out, name);
    CHECK(grid->saveFloatAsHalf() == halves);
    // Half floats have 11 bits: a number below 1 is off by 2^-12 at most.
    const double most = halves ? 0x1p-12 : 0x1p-24;
    const openvdb::Vec3f first = grid->tree().getValue(openvdb::Coord(0));
    CHECK(std::abs(first[0] - 16 / 255.0) <= most);
    CHECK(std::abs(first[1] - 32 / 255.0) <= most);
    CHECK(first[2] == 1);
    CHECK(report.grids.at(0).build.maxError <= most);
    CHECK(report.grids.at(0).verified->error.max <= most);
    CHECK(grid->getVectorType() == openvdb::VEC_INVARIANT);
  }
}

TEST_CASE("Labels stand in the world of the target as half floats and keep their names", "[convert][target]") {
  const TemporaryFolder folder;
  const fs::path input = folder.path() / "in.seg.nrrd", out = folder.path() / "out.vdb";
  writeBytes(input,
             "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 2 2\n"
             "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (-30,-40,5)\nspace units: \"mm\" \"mm\" \"mm\"\n"
             "encoding: raw\nSegment0_Name:=liver\nSegment0_LabelValue:=5\n\n" +
                 std::string("\5\0\2\0\0\0\0\0\0\0\0\5", 12));
  ConvertOptions options = readyFor(Target::houdini);
  options.labels.emplace();
  const ConvertReport report = convert({input}, out, options);
  REQUIRE(report.grids.size() == 2);
  const ScalarGrid liver = readScalarGrid(out, "liver");
  CHECK(liver.grid->saveFloatAsHalf());
  CHECK(liver.grid->activeVoxelCount() == 2);
  CHECK(liver.grid->tree().getValue(kLast) == 1);
  // (-26, -37, 9) mm of LPS, as for grids of floats.
  const openvdb::Vec3d place = liver.grid->indexToWorld(kLast);
  CHECK((place - openvdb::Vec3d(-0.026, 0.009, 0.037)).length() <= 1e-12);
  CHECK(liver.metadata("length_unit") == "m");
  CHECK(readScalarGrid(out, "label_2").grid->activeVoxelCount() == 1);
  CHECK(report.grids[0].build.maxError == 0);
  CHECK(report.grids[0].verified->error.max == 0);
  CHECK(report.notes.empty());
}

TEST_CASE("Values and vectors of one file are made ready together, frame by frame", "[convert][target]") {
  const WayFile file;
  const fs::path values = file.folder.path() / "rho.nrrd", vectors = file.write("left-posterior-superior");
  writeBytes(values,
             "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 2 2\n"
             "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (-30,-40,5)\nencoding: raw\n\n" +
                 std::string("\0\0\0\0\0\0\0\0\0\0\0\7", 12));
  const ConvertReport report = convert({values, vectors}, file.out, readyFor(Target::blender));
  CHECK(report.grids.at(0).label == "density");
  CHECK(report.grids.at(1).label == "velocity");
  CHECK(readScalarGrid(file.out, "density").grid->tree().getValue(kLast) == 1);
  CHECK(readVectorGrid(file.out, "velocity")->tree().getValue(kLast)[0] == Approx(0.004));
}
