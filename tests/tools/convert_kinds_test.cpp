// Kinds of input that people meet, by the command line: frames of HDF5, bytes behind voxels, segmentations, vectors for
// other programs.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <string>

#include "ingest/dicom_segmentation.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("Frames and colours of a netCDF file are told and picked as those of other formats", "[tools]") {
  const TemporaryFolder folder;
  fs::copy_file(UMBRICK_FUZZ_CORPUS "/hdf5/seed-frames", folder.path() / "f.nc");  // 2 frames of 1 x 2 x 2 colours
  const ProgramResult info = runProgram(folder, "info f.nc");
  CHECK(info.status == 0);
  CHECK_THAT(info.out, Contains("frames         2") && Contains("components     3, colour") &&
                           Contains("to pick one    --frame 0 to 1, --component 0 to 2 or magnitude") &&
                           Contains("\"time\", is taken for frames, by its name or unit"));
  const ProgramResult none = runProgram(folder, "convert f.nc -o o.vdb");
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("a sequence of 2 volumes, frame 0 to 1") && Contains("give --frame N"));
  CHECK(runProgram(folder, "convert f.nc --frame 1 --component g --verify -o g.nrrd").status == 0);
  // The numbers of the file count up from 0: the greens of the second frame are every third one from 13 on.
  CHECK_THAT(readBytes(folder.path() / "g.nrrd"), Catch::EndsWith(std::string("\x0d\x10\x13\x16")));
  const ProgramResult each = runProgram(folder, "convert f.nc --verify --frames 0-1 -o o_%d.vdb");
  CHECK(each.status == 0);
  CHECK(fs::exists(folder.path() / "o_0.vdb"));
  CHECK(fs::exists(folder.path() / "o_1.vdb"));
}

TEST_CASE("Raw voxels that are longer than said are read with a doubt, and refused when strict", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", "abcdefgh and more");
  const std::string command = "convert v.raw --dims 2 2 2 --type u8 -o o.vdb";
  const ProgramResult read = runProgram(folder, command);
  CHECK(read.status == 0);
  CHECK_THAT(read.err, Contains("v.raw has 17 bytes of voxels for 2 x 2 x 2 u8 = 8 bytes: the last 9 are left out") &&
                           Contains("or are the dims or the type wrong?"));
  const ProgramResult strict = runProgram(folder, command + " --strict");
  CHECK(strict.status == 1);
  CHECK_THAT(strict.err, Contains("expected 2 x 2 x 2 u8 = 8 bytes, found 17"));
}

TEST_CASE("A segmentation without its option names the way out, and is cropped with it", "[tools]") {
  const TemporaryFolder folder;
  using namespace umbrick::dicom_files;
  writeBytes(folder.path() / "s.dcm", segmentation({{1, 0}, {2, 0}, {1, 2.5}}).file());
  const ProgramResult plain = runProgram(folder, "convert s.dcm -o o.vdb");
  CHECK(plain.status == 1);
  CHECK_THAT(plain.err, Contains("a DICOM segmentation of 2 segments") && Contains("; convert --labels makes them"));
  const ProgramResult info = runProgram(folder, "info s.dcm");
  CHECK(info.status == 0);
  CHECK_THAT(info.out, Contains("label          1: liver") && Contains("label          2: vessel") &&
                           Contains("to pick one    convert --labels"));
  const ProgramResult cropped =
      runProgram(folder, "convert s.dcm --labels --crop 0 0 0 4 4 1 --space ras --verify -o o.vdb");
  CHECK(cropped.status == 0);
  CHECK_THAT(cropped.out, Contains("grid \"liver\"") && Contains("of 50 ("));  // 5 x 5 x 2 voxels
  CHECK_THAT(cropped.err, Contains("turned from LPS to RAS"));
  const ProgramResult placed = runProgram(folder, "convert s.dcm --labels --spacing 1 1 1 -o o.vdb");
  CHECK(placed.status == 2);
  CHECK_THAT(placed.err, Contains("--spacing is not for segments of a DICOM segmentation"));
}

TEST_CASE("Vectors for another program say how they were turned, scaled and named", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.nrrd",
             "NRRD0005\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: 3 1 1 1\nencoding: raw\n"
             "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: vector domain domain domain\n"
             "space units: \"mm\" \"mm\" \"mm\"\n\n\1\2\3");
  const ProgramResult result = runProgram(folder, "convert v.nrrd --to houdini --unit mm/s --verify -o o.vdb");
  CHECK(result.status == 0);
  CHECK_THAT(result.err,
             Contains("vectors turn with the axes; their lengths are multiplied by 0.001, from mm/s to m/s") &&
                 Contains("grid \"v\" is called vel, as Houdini calls velocities"));
  CHECK_THAT(result.out, Contains("grid \"vel\"") && Contains("verified"));
}
