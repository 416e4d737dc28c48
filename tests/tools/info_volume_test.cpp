// umbrick info of files that are no grids.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kVoxels{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};  // 3 x 2 x 2

void writeVolume(const TemporaryFolder& folder, const std::string& name) {
  writeBytes(folder.path() / name,
             "NRRD0004\ntype: uint8\ndimension: 3\nspace: RAS\nsizes: 3 2 2\n"
             "space directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (10,20,30)\nencoding: raw\n\n" +
                 kVoxels);
}

// An image of points with an array of each name; the second one has three components.
void writeArrays(const TemporaryFolder& folder, const std::string& name) {
  const auto array = [](const char* called, const char* components, const char* values) {
    return std::string("<DataArray type=\"UInt8\" Name=\"") + called + "\" NumberOfComponents=\"" + components +
           "\" format=\"ascii\">" + values + "</DataArray>";
  };
  writeBytes(folder.path() / name,
             "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 0\"><Piece Extent=\"0 1 0 1 0 0\">"
             "<PointData>" +
                 array("heat", "1", "1 2 3 4") + array("vel", "3", "1 2 3 4 5 6 7 8 9 10 11 12") +
                 array("smoke", "1", "5 6 7 8") + "</PointData></Piece></ImageData></VTKFile>");
}

nlohmann::json infoOf(const TemporaryFolder& folder, const std::string& arguments) {
  const ProgramResult result = runProgram(folder, "info --json " + arguments);
  CAPTURE(arguments, result.err);
  REQUIRE(result.status == 0);
  return nlohmann::json::parse(result.out);
}

}  // namespace

TEST_CASE("info tells size, type, place, world and values of a volume", "[tools]") {
  const TemporaryFolder folder;
  writeVolume(folder, "v.nrrd");
  const nlohmann::json info = infoOf(folder, "v.nrrd --bins 4");
  const nlohmann::json& volume = info.at("volume");
  CHECK(volume.at("dims") == nlohmann::json({3, 2, 2}));
  CHECK(volume.at("type") == "u8");
  CHECK(volume.at("spacing") == nlohmann::json({2.0, 3.0, 4.0}));
  CHECK(volume.at("origin") == nlohmann::json({10.0, 20.0, 30.0}));
  CHECK(volume.at("index_to_world").at(0) == nlohmann::json({0.0, -3.0, 0.0, 10.0}));
  CHECK(volume.at("metadata").at("space") == "RAS");
  CHECK(info.at("values").at("min") == 0);
  CHECK(info.at("values").at("max") == 11);
  CHECK(info.at("values").at("histogram") == nlohmann::json({3, 3, 3, 3}));
  CHECK(info.at("values").at("non_finite") == 0);
  const std::string text = runProgram(folder, "info v.nrrd").out;
  CHECK_THAT(text, Contains("3 x 2 x 2 u8, 12 bytes unpacked") && Contains("2 x 3 x 4 world units") &&
                       Contains("(0, 1, 0), (-1, 0, 0), (0, 0, 1)") && Contains("0 to 11, voxels by value"));
}

TEST_CASE("info of headerless raw takes the layout that convert takes", "[tools]") {
  const TemporaryFolder folder;
  const float values[]{1, 2, std::nanf(""), 4};
  writeBytes(folder.path() / "f.raw", std::string(reinterpret_cast<const char*>(values), sizeof values));
  const nlohmann::json info = infoOf(folder, "f.raw --dims 2 2 1 --type f32 --bins 3");
  CHECK(info.at("values").at("non_finite") == 1);
  CHECK(info.at("values").at("histogram") == nlohmann::json({1, 1, 1}));
  CHECK_THAT(runProgram(folder, "info x.vdb --dims 2 2 1 --type f32").err, Contains("not for .vdb"));
  writeBytes(folder.path() / "v.raw", kVoxels);
  const ProgramResult bare = runProgram(folder, "info v.raw");
  CHECK(bare.status != 0);
  CHECK_THAT(bare.err, Contains("headerless raw") && Contains("--dims and --type"));
  const ProgramResult lost = runProgram(folder, "info nothing.nrrd");
  CHECK(lost.status == 1);
  CHECK_THAT(lost.err, Contains("nothing.nrrd: cannot read: No such file"));
}

TEST_CASE("info lists the arrays of a file, and describes the one that is named", "[tools]") {
  const TemporaryFolder folder;
  writeArrays(folder, "a.vti");
  const nlohmann::json all = infoOf(folder, "a.vti");
  CHECK(!all.contains("volume"));
  REQUIRE(all.at("arrays").size() == 3);
  CHECK(all.at("arrays").at(0).at("name") == "heat");
  CHECK(all.at("arrays").at(1).at("type") == "3 x u8");
  CHECK(all.at("arrays").at(2).at("volume") == true);
  CHECK_THAT(runProgram(folder, "info a.vti").out, Contains("several volumes") && Contains("a.vti:heat"));
  CHECK(infoOf(folder, "a.vti:smoke").at("values").at("min") == 5);
}

TEST_CASE("info lists the arrays of a legacy VTK file, also behind the voxels", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "l.vtk",
             "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
             "ORIGIN 0 0 0\nSPACING 1 1 1\nFIELD f 1\nTIME 1 1 float\n7\nPOINT_DATA 4\n"
             "SCALARS first float 1\nLOOKUP_TABLE default\n1 2 3 4\nVECTORS flow float\n1 2 3 4 5 6 7 8 9 10 11 12\n"
             "FIELD g 1\nlast 1 4 short\n5 6 7 8\n");
  const nlohmann::json info = infoOf(folder, "l.vtk");
  CHECK(info.at("values").at("max") == 4);
  std::string rows;
  for (const auto& row : info.at("arrays"))
    rows += row.at("name").get<std::string>() + (row.at("volume") == true ? "+ " : "- ");
  CHECK(rows == "TIME- first+ flow+ last+ ");
}

TEST_CASE("info of a numbered sequence describes its first frame and counts the others", "[tools]") {
  const TemporaryFolder folder;
  for (const char* name : {"f_2.nrrd", "f_3.nrrd", "f_7.nrrd"}) writeVolume(folder, name);
  const nlohmann::json info = infoOf(folder, "'f_%d.nrrd'");
  CHECK(info.at("frames").at("count") == 3);
  CHECK(info.at("frames").at("first") == 2);
  CHECK(info.at("frames").at("last") == 7);
  CHECK(info.at("volume").at("dims") == nlohmann::json({3, 2, 2}));
}

TEST_CASE("info tells of volumes with several frames, components or labels, and how one is picked", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "c.nrrd",
             "NRRD0004\ntype: uint8\ndimension: 5\nsizes: 3 3 2 2 2\nkinds: RGB-color domain domain domain list\n"
             "encoding: raw\n\n" +
                 std::string(72, '\4'));
  const nlohmann::json both = infoOf(folder, "c.nrrd");
  CHECK(both.at("volume").at("components") == 3);
  CHECK(both.at("volume").at("frames") == 2);
  CHECK(both.at("volume").at("meaning") == "colour");
  CHECK(both.at("to_pick") == "--frame 0 to 1, --component 0 to 2 or magnitude");
  CHECK(!both.contains("values"));
  CHECK_THAT(runProgram(folder, "info c.nrrd").out, Contains("components     3, colour") && Contains("to pick one"));
  CHECK(infoOf(folder, "c.nrrd --frame 1 --component 2").at("values").at("max") == 4);

  writeBytes(folder.path() / "l.seg.nrrd",
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: raw\nSegment0_Name:=liver\n"
             "Segment0_LabelValue:=5\nSegment0_Color:=1 0 0.5\n\n" +
                 kVoxels);
  const nlohmann::json labels = infoOf(folder, "l.seg.nrrd").at("volume").at("labels");
  REQUIRE(labels.size() == 1);
  CHECK(labels.at(0).at("name") == "liver");
  CHECK(labels.at(0).at("value") == 5);
  CHECK(labels.at(0).at("colour") == nlohmann::json({1.0, 0.0, 0.5}));
}
