// Components, frames and labels by the options of umbrick convert.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "tools/program.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// 2 x 2 x 2 voxels of three bytes, in two frames.
void writeColours(const TemporaryFolder& folder, int frames) {
  std::string bytes;
  for (int i = 0; i < 24 * frames; ++i) bytes += static_cast<char>(i + 1);
  writeBytes(folder.path() / "c.nrrd", "NRRD0005\ntype: uchar\ndimension: 5\nsizes: 3 2 2 2 " + std::to_string(frames) +
                                           "\nkinds: RGB-color domain domain domain time\nencoding: raw\n\n" + bytes);
}

}  // namespace

TEST_CASE("Colours become one grid, or a grid of each, and lines say so", "[tools]") {
  const TemporaryFolder folder;
  writeColours(folder, 1);
  const ProgramResult one = runProgram(folder, "convert c.nrrd -o o.vdb --verify");
  CHECK(one.status == 0);
  CHECK(one.err ==
        "c.nrrd: voxels of three numbers, a colour, become the grid of vec3 \"Cd\"\n"
        "c.nrrd: colours are divided by 255 to lie from 0 to 1, and keep the tone curve of the file\n");
  CHECK_THAT(one.out, Contains("grid \"Cd\"") && Contains("8 voxels read back, maximum error 0,"));
  CHECK_THAT(runProgram(folder, "convert c.nrrd -o e.vdb --component all").out,
             Contains("grid \"Cd_r\"") && Contains("grid \"Cd_g\"") && Contains("grid \"Cd_b\""));
  CHECK_THAT(runProgram(folder, "convert c.nrrd -o g.vdb --component g --name green").out, Contains("grid \"green\""));
  const ProgramResult dense = runProgram(folder, "convert c.nrrd -o o.mhd");
  CHECK(dense.status == 2);
  CHECK_THAT(dense.err, Contains("o.mhd: expected a .vdb for a grid of vec3; of its numbers one is chosen by "
                                 "--component, and --component all makes a grid of each"));
  const ProgramResult half = runProgram(folder, "convert c.nrrd -o o.vdb --half");
  CHECK(half.status == 2);
  CHECK_THAT(half.err, Contains("c.nrrd: --half is not for a grid of vec3: choose one of its numbers by --component"));
  CHECK_THAT(runProgram(folder, "convert c.nrrd -o o.vdb --component w").err,
             Contains("--component: expected a number from 0, x, y, z, r, g, b, a or magnitude, found w"));
}

TEST_CASE("Frames of one file are picked, and a line says how many there are", "[tools]") {
  const TemporaryFolder folder;
  writeColours(folder, 4);
  const ProgramResult none = runProgram(folder, "convert c.nrrd -o o.vdb --component 0");
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("c.nrrd: a sequence of 4 volumes, frame 0 to 3, of which one has to be chosen; give "
                                "--frame N, or convert all with -o and a numbered name, as out_%04d.vdb"));
  CHECK(runProgram(folder, "convert c.nrrd -o o.vdb --component 0 --frame 2").status == 0);
  const ProgramResult all = runProgram(folder, "convert c.nrrd -o o%d.vdb --frames 1-3:2 --component 0 --verify");
  CHECK(all.status == 0);
  CHECK_THAT(all.out, Contains("o1.vdb: ") && Contains("o3.vdb: ") && Contains("o%d.vdb: 2 frames, "));
  CHECK_THAT(runProgram(folder, "convert c.nrrd -o o.vdb --frames 1-3").err,
             Contains("c.nrrd: expected an output with a number in its name, such as out_%04d.vdb, found o.vdb"));
}

TEST_CASE("Labels follow --labels or not, wherever the input stands", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "l.nrrd",
             "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n"
             "Segment0_Name:=liver\nSegment0_LabelValue:=7\n\n" +
                 std::string("\7\0\3\3", 4));
  for (const char* arguments : {"--labels l.nrrd -o o.vdb", "l.nrrd --labels -o o.vdb", "l.nrrd -o o.vdb --labels"}) {
    const ProgramResult result = runProgram(folder, std::string("convert --verify ") + arguments);
    CHECK(result.status == 0);
    CHECK_THAT(result.out, Contains("grid \"liver\"") && Contains("grid \"label_3\""));
  }
  const std::string some = runProgram(folder, "convert l.nrrd -o o.vdb --labels liver").out;
  CHECK_THAT(some, Contains("grid \"liver\"") && !Contains("label_3"));
  const ProgramResult missing = runProgram(folder, "convert l.nrrd -o o.vdb --labels 3,spleen");
  CHECK(missing.status == 1);
  CHECK_THAT(missing.err, Contains("label spleen: expected a value, or one of the names liver"));
}

TEST_CASE("A picture is made of one number of each voxel, of grids of vec3 and of volumes", "[tools]") {
  const TemporaryFolder folder;
  writeColours(folder, 2);
  CHECK(runProgram(folder, "convert c.nrrd -o o.vdb --frame 0").status == 0);
  const ProgramResult none = runProgram(folder, "info --suggest-tf o.vdb");
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("o.vdb: no scalar grid") && Contains("; render --component x, y, z or magnitude"));
  for (const char* arguments : {"o.vdb --component magnitude", "o.vdb --component g", "o.vdb --component 2",
                                "c.nrrd --component x --frame 1", "c.nrrd --component magnitude --frame 1"}) {
    const ProgramResult result = runProgram(folder, std::string("info --suggest-tf ") + arguments);
    INFO(arguments << result.err);
    CHECK(result.status == 0);
  }
  CHECK_THAT(runProgram(folder, "info --suggest-tf o.vdb --component 3").err, Contains("component: expected 0 to 2"));
  CHECK_THAT(runProgram(folder, "info --suggest-tf o.vdb --component x --frame 1").err,
             Contains("o.vdb: --frame is for files of several volumes"));
  CHECK_THAT(runProgram(folder, "info --suggest-tf c.nrrd --frame 1").err,
             Contains("voxels of 3 numbers, component 0 to 2, of which one has to be chosen; give --component N"));
}
