// A file for each of many numbered files.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"
#include "tools/refusal.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

// 8 x 3 x 2 voxels of u8, all 0 but voxel n, which is n.
void writeFrame(const TemporaryFolder& folder, int n, std::size_t cut = 0) {
  std::string voxels(48, '\0');
  voxels[static_cast<std::size_t>(n)] = static_cast<char>(n);
  char name[32];
  std::snprintf(name, sizeof name, "f_%03d.nrrd", n);
  const std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 3 2\nencoding: raw\n\n" + voxels;
  writeBytes(folder.path() / name, bytes.substr(0, bytes.size() - cut));
}

// The only active voxel of a file.
double valueOf(const TemporaryFolder& folder, const std::string& file) {
  const nlohmann::json info = nlohmann::json::parse(runProgram(folder, "info --json " + file).out);
  CHECK(info.at("grids").at(0).at("active_voxels") == 1);
  return info.at("grids").at(0).at("values").at("max");
}

std::size_t outputs(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for (const auto& file : fs::directory_iterator(folder.path())) count += file.path().string().ends_with(".vdb");
  return count;
}

}  // namespace

TEST_CASE("Each frame becomes a file of its number, gaps are told in one line", "[tools]") {
  const TemporaryFolder folder;
  for (const int n : {2, 3, 7, 10, 30}) writeFrame(folder, n);
  const ProgramResult all =
      runProgram(folder, "convert f_%03d.nrrd -o o%d.vdb --verify --background auto --name smoke");
  CHECK(all.status == 0);
  CHECK(all.err == "f_%03d.nrrd: 24 frames are missing: 4 to 6, 8 to 9, 11 to 29\n");
  CHECK(std::count(all.out.begin(), all.out.end(), '\n') == 6);
  CHECK_THAT(all.out, Contains("o7.vdb: 1 of 48 voxels active, maximum error 0, ") &&
                          Contains(" bytes, background 0, verified\n") && Contains("o%d.vdb: 5 frames, "));
  CHECK(all.out.find("o2.vdb") < all.out.find("o10.vdb"));
  for (const int n : {2, 3, 7, 10, 30}) CHECK(valueOf(folder, "o" + std::to_string(n) + ".vdb") == n);
  CHECK_THAT(runProgram(folder, "info o30.vdb").out, Contains("grid \"smoke\""));

  const ProgramResult some = runProgram(folder, "convert f_%03d.nrrd -o p_%02d.vdb --frames 1-13:3 --crop 0 0 0 7 2 1");
  CHECK(some.err == "f_%03d.nrrd: 3 frames are missing: 1 to 4, 13\n");
  CHECK(valueOf(folder, "p_07.vdb") == 7);
  CHECK(valueOf(folder, "p_10.vdb") == 10);
  CHECK(outputs(folder) == 7);

  // Grids too.
  CHECK_THAT(runProgram(folder, "convert o%d.vdb -o q%d.vdb --frames 3-9 --verify").out,
             Contains("q3.vdb: 1 of 1 voxels active, ") && Contains(", verified\n") && Contains(": 2 frames, "));
  CHECK(valueOf(folder, "q3.vdb") == 3);
  CHECK(valueOf(folder, "q7.vdb") == 7);
  CHECK(outputs(folder) == 9);
}

TEST_CASE("Frames have masks of their own, or one for all", "[tools]") {
  const TemporaryFolder folder;
  for (const int n : {1, 2}) writeBytes(folder.path() / ("v" + std::to_string(n)), "\7\7\7\7");
  writeBytes(folder.path() / "m1", std::string("\1\0\0\0", 4));
  writeBytes(folder.path() / "m2", std::string("\1\1\1\0", 4));
  const std::string raw = "convert v%d --dims 4 1 1 --type u8 -o o%d.vdb ";
  CHECK_THAT(runProgram(folder, raw + "--mask m%d").out, Contains("o1.vdb: 1 of 4") && Contains("o2.vdb: 3 of 4"));
  CHECK_THAT(runProgram(folder, raw + "--mask m2").out, Contains("o1.vdb: 3 of 4") && Contains("o2.vdb: 3 of 4"));
}

TEST_CASE("A frame that fails ends the run: those before stay, it and what follows leave nothing", "[tools]") {
  const TemporaryFolder folder;
  for (const int n : {1, 2, 3, 4}) writeFrame(folder, n, n == 3 ? 5 : 0);
  const std::size_t before = filesIn(folder);
  const ProgramResult result = runProgram(folder, "convert f_%03d.nrrd -o o%d.vdb");
  CHECK(result.status == 1);
  CHECK(result.err == "umbrick: frame 3: f_003.nrrd: expected 48 bytes of u8 voxels, found 43\n");
  CHECK(filesIn(folder) == before + 2);
  CHECK(valueOf(folder, "o2.vdb") == 2);
  CHECK_FALSE(fs::exists(folder.path() / "o3.vdb"));
  // The size of a packed frame shows only when it has been read.
  const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 3 2\nencoding: gzip\n\n";
  writeBytes(folder.path() / "f_003.nrrd", head + gzipped(std::string(47, 'x')));
  CHECK(runProgram(folder, "convert f_%03d.nrrd -o o%d.vdb").err ==
        "umbrick: frame 3: f_003.nrrd: expected 8 x 3 x 2 u8 = 48 bytes, found 47\n");
  CHECK(filesIn(folder) == before + 2);
  // As much for .vdb files.
  writeBytes(folder.path() / "o3.vdb", readBytes(folder.path() / "o2.vdb").substr(0, 300));
  const ProgramResult grids = runProgram(folder, "convert o%d.vdb -o p%d.vdb");
  CHECK(grids.status == 1);
  CHECK_THAT(grids.err, Contains("umbrick: frame 3: o3.vdb: truncated or corrupt"));
  CHECK(std::count(grids.err.begin(), grids.err.end(), '\n') == 1);
  CHECK(filesIn(folder) == before + 5);
}

TEST_CASE("Numbers on one side only, or in what cannot be frames, are wrong usage", "[tools]") {
  const TemporaryFolder folder;
  writeFrame(folder, 1);
  writeFrame(folder, 2);
  // Grey images of 1 x 1: no frames, but slices.
  const std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x8\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT\x78\x9c\x63\x60\0\0\0\2\0\1"
      "\x48\xaf\xa4\x71\0\0\0\0IEND\xae\x42\x60\x82",
      67);
  writeBytes(folder.path() / "s1.png", png);
  writeBytes(folder.path() / "s2.png", png);
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    expectRefusal(folder, "convert " + arguments, status, message);
  };
  refused("f_%03d.nrrd -o o.vdb", 2, "f_%03d.nrrd: expected an output with a number in its name too");
  refused("f_%03d.nrrd -o o_%s.vdb", 2, "such as out_%04d.vdb, found o_%s.vdb");
  refused("f_001.nrrd -o o_%d.vdb", 2, "o_%d.vdb: expected an input with a number in its name too");
  refused("f_001.nrrd --frames 1-2 -o o.vdb", 2, "--frames: expected an input with a number in its name");
  refused("f_%03d.nrrd f_001.nrrd -o o_%d.vdb", 2, "expected one input where frames are numbered, found 2");
  for (const char* range : {"2-1", "x", "1-", "1-2:0", "1-2:", "-", "1-2-3"})
    refused(std::string("f_%03d.nrrd -o o_%d.vdb --frames=") + range, 2, "--frames: expected A, A-B or A-B:step");
  refused("f_%03d.nrrd -o o_%d.vdb --frames=-1", 1, "f_%03d.nrrd: expected frames of -1, found none");
  refused("f_%03d.nrrd -o o_%d.vdb --frames 3-9", 1, "f_%03d.nrrd: expected frames of 3-9, found none");
  refused("g_%03d.nrrd -o o_%d.vdb", 1, "g_%03d.nrrd: expected files of that pattern, found none");
  refused("f_%03d.nrrd -o none/o_%d.vdb", 1, "none/o_1.vdb: cannot write");
  refused("f_%03d.nrrd -o f_%03d.nrrd", 2, "which would be overwritten");
  refused("s%d.png -o o_%d.vdb", 2, "s1.png: expected a TIFF of several pages for each frame, found one image");
  CHECK_THAT(runProgram(folder, "convert s%d.png -o o.vdb").out, Contains("of 2 ("));
}
