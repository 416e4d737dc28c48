// Grids that are made ready for other programs.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <catch2/catch.hpp>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::vector<std::int16_t> kValues{-1000, -1000, -1000, -1000, 200, -500, 1000, -1000, -1000, -1000, -1000, -1000};

// 3 x 2 x 2 voxels of 2, 3 and 4 mm, the first at (-30, -40, 5), in a space that the file states.
struct TargetScan {
  TemporaryFolder folder;
  fs::path out = folder.path() / "out.vdb";
  fs::path write(const std::string& space, const std::string& unit = "mm", const std::string& size = "2") const {
    const std::string units = "space units: \"" + unit + "\" \"" + unit + "\" \"" + unit + "\"\n";
    const auto path = folder.path() / "in.nrrd";
    writeBytes(path, "NRRD0004\ntype: int16\ndimension: 3\n" +
                         (space.empty() ? "space dimension: 3\n" : "space: " + space + '\n') +
                         "sizes: 3 2 2\nspace directions: (" + size + ",0,0) (0,3,0) (0,0,4)\n" +
                         "space origin: (-30,-40,5)\n" + (unit.empty() ? "" : units) +
                         "encoding: raw\nendian: little\n\n" + bytesOf(kValues));
    return path;
  }
};

ConvertOptions forTarget(Target target) {
  ConvertOptions options;
  options.output.target = target;
  options.verify = true;
  return options;
}

openvdb::Vec3d placeOf(const fs::path& file, const openvdb::Coord& at = {2, 1, 1}) {
  return readScalarGrid(file).grid->indexToWorld(at);
}

void checkNear(const openvdb::Vec3d& found, const openvdb::Vec3d& expected) {
  CAPTURE(found, expected);
  CHECK((found - expected).length() <= 1e-12 * expected.length());
}

}  // namespace

// The last voxel is at (-26, -37, 9) mm in LPS: 26 mm to the right of the patient, 37 in front, 9 up.
TEST_CASE("Each target gets its unit, its axis that is up, and a patient who faces its front", "[convert][target]") {
  const TargetScan scan;
  for (const bool ras : {false, true}) {
    const auto input = scan.write(ras ? "right-anterior-superior" : "left-posterior-superior");
    // The same numbers in RAS are a point to the left of the patient and behind.
    const double side = ras ? -1 : 1;
    convert({input}, scan.out, forTarget(Target::blender));
    checkNear(placeOf(scan.out), {side * -0.026, side * -0.037, 0.009});
    convert({input}, scan.out, forTarget(Target::houdini));
    checkNear(placeOf(scan.out), {side * -0.026, 0.009, side * 0.037});
    convert({input}, scan.out, forTarget(Target::omniverse));
    checkNear(placeOf(scan.out), {side * -2.6, 0.9, side * 3.7});
    convert({input}, scan.out, forTarget(Target::unreal));
    checkNear(placeOf(scan.out), {side * -2.6, side * 3.7, 0.9});
  }
  // A left-handed space, whose x points to the patient's left and whose y to the front.
  convert({scan.write("left-anterior-superior")}, scan.out, forTarget(Target::blender));
  checkNear(placeOf(scan.out), {-0.026, 0.037, 0.009});
  CHECK(readScalarGrid(scan.out).metadata("space") == "LPS");
  convert({scan.write("right-anterior-superior")}, scan.out, forTarget(Target::houdini));
  CHECK(readScalarGrid(scan.out).metadata("space") == "LSA");
}

TEST_CASE("Values go from 0, the background, to 1, and the metadata bring them back", "[convert][target]") {
  const TargetScan scan;
  const ConvertReport report = convert({scan.write("left-posterior-superior")}, scan.out, forTarget(Target::blender));
  const ScalarGrid grid = readScalarGrid(scan.out);
  CHECK(grid.grid->saveFloatAsHalf());
  CHECK(grid.grid->background() == 0);
  CHECK(grid.grid->activeVoxelCount() == 3);
  CHECK(grid.grid->metaValue<double>("value_low") == -1000);
  CHECK(grid.grid->metaValue<double>("value_high") == 1000);
  CHECK(grid.grid->tree().getValue({0, 0, 1}) == 1);
  // Half floats have 11 bits, so that a share below 1 is off by 2^-12 at most, of a range of 2000.
  CHECK(-1000 + 2000 * grid.grid->tree().getValue({1, 1, 0}) == Approx(200).margin(2000.0 / 4096));
  CHECK(-1000 + 2000 * grid.grid->tree().getValue({2, 1, 0}) == Approx(-500).margin(2000.0 / 4096));
  CHECK(report.grids[0].build.maxError <= 2000.0 / 4096);
  CHECK(report.grids[0].verified->error.max == Approx(report.grids[0].build.quantising.max));
  CHECK(grid.metadata("length_unit") == "m");

  ConvertOptions exact = forTarget(Target::blender);
  exact.build.maxError = 0.01f;  // which half floats do not keep
  const ConvertReport kept = convert({scan.folder.path() / "in.nrrd"}, scan.out, exact);
  CHECK(kept.grids[0].build.maxError <= 0.01);
  CHECK(!readScalarGrid(scan.out).grid->saveFloatAsHalf());

  convert({scan.folder.path() / "in.nrrd"}, scan.out, forTarget(Target::houdini));
  CHECK(readScalarGrid(scan.out).grid->tree().getValue({0, 0, 1}) == 1000);
}

TEST_CASE("What lies below a background that is given is left out and counted", "[convert][target]") {
  const TargetScan scan;
  ConvertOptions options = forTarget(Target::unreal);
  options.build.background = 0.0f;
  const ConvertReport report = convert({scan.write("left-posterior-superior")}, scan.out, options);
  CHECK(report.grids[0].build.clippedVoxels == 10);
  CHECK(readScalarGrid(scan.out).grid->activeVoxelCount() == 2);
  CHECK(readScalarGrid(scan.out).grid->tree().getValue({1, 1, 0}) == Approx(0.2).margin(1e-4));
}

TEST_CASE("Voxels that are too small for OpenVDB, and unknown units, are said", "[convert][target]") {
  const TargetScan scan;
  const auto note = [&](const fs::path& input) {
    return convert({input}, scan.out, forTarget(Target::blender)).grids[0].notes.at(0);
  };
  CHECK_THAT(note(scan.write("", "um")), Contains("1e-3 m") && Contains("OpenVDB"));
  checkNear(placeOf(scan.out, {1, 0, 0}) - placeOf(scan.out, {0, 0, 0}), {0.002, 0, 0});
  CHECK_THAT(note(scan.write("", "")), Contains("no unit of length") && Contains("taken for m"));
  checkNear(placeOf(scan.out), {-26, -37, 9});
}

TEST_CASE("Grids of files stand with y up unless it is said otherwise, and get the name that is looked for",
          "[convert][target]") {
  openvdb::initialize();
  const TemporaryFolder folder;
  const auto input = folder.path() / "in.vdb", out = folder.path() / "out.vdb";
  auto smoke = openvdb::FloatGrid::create(), heat = openvdb::FloatGrid::create();
  smoke->setName("smoke");
  heat->setName("temperature");
  for (const auto& grid : {smoke, heat}) {
    grid->tree().setValue({1, 3, 2}, 4);  // taller along y than along z
    grid->tree().setValue({0, 0, 0}, 2);
  }
  openvdb::io::File(input.string()).write({heat, smoke});
  const ConvertReport report = convert({input}, out, forTarget(Target::blender));
  CHECK_THAT(report.notes.at(0), Contains("\"smoke\" is called density"));
  checkNear(readScalarGrid(out, "density").grid->indexToWorld(openvdb::Coord(1, 3, 2)), {1, -2, 3});
  checkNear(readScalarGrid(out, "temperature").grid->indexToWorld(openvdb::Coord(1, 3, 2)), {1, -2, 3});
  ConvertOptions upright = forTarget(Target::blender);
  upright.output.up = Axis::z;
  convert({input}, out, upright);
  checkNear(readScalarGrid(out, "density").grid->indexToWorld(openvdb::Coord(1, 3, 2)), {1, 3, 2});
}

TEST_CASE("Distances of a level set follow the unit of length", "[convert][target]") {
  openvdb::initialize();
  const TemporaryFolder folder;
  const auto input = folder.path() / "in.vdb", out = folder.path() / "out.vdb";
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10, {1, 2, 3}, 1);
  sphere->setName("surface");
  sphere->insertMeta("length_unit", openvdb::StringMetadata("mm"));
  openvdb::io::File(input.string()).write({sphere});
  convert({input}, out, forTarget(Target::houdini));
  const ScalarGrid grid = readScalarGrid(out);
  CHECK(grid.isLevelSet());
  CHECK(grid.name == "surface");
  CHECK(grid.grid->background() == Approx(0.003));
  CHECK(grid.grid->tree().getValue({11, 2, 3}) == Approx(0).margin(1e-9));
  CHECK(grid.grid->tree().getValue({12, 2, 3}) == Approx(0.001));
}

TEST_CASE("Limits of a target are said with the spacing that keeps them", "[convert][target]") {
  openvdb::initialize();
  const TemporaryFolder folder;
  const auto input = folder.path() / "in.vdb", out = folder.path() / "out.vdb";
  auto wide = openvdb::FloatGrid::create();
  wide->tree().setValue({0, 0, 0}, 1);
  wide->tree().setValue({4095, 9, 9}, 2);
  openvdb::io::File(input.string()).write({wide});
  for (const Target target : {Target::blender, Target::unreal}) {
    const auto notes = convert({input}, out, forTarget(target)).grids[0].notes;
    CHECK_THAT(notes.back(), Contains("2048") && Contains("4096 x 10 x 10") && Contains("spacing 2 2 2"));
  }
  for (const Target target : {Target::houdini, Target::omniverse})
    CHECK_THAT(convert({input}, out, forTarget(target)).grids[0].notes.back(), !Contains("4096"));
}

TEST_CASE("A target is for .vdb files", "[convert][target]") {
  const TargetScan scan;
  const auto input = scan.write("");
  for (const char* name : {"out.nvdb", "out.mhd", "out.nrrd"})
    CHECK_THROWS_AS(convert({input}, scan.folder.path() / name, forTarget(Target::blender)), OptionsError);
}
