// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/frame_sequence.h"

#include <catch2/catch.hpp>

#include "support/complaint.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

TEST_CASE("Frames come in the order of their numbers, gaps and all", "[ingest]") {
  const TemporaryFolder folder;
  for (const char* name : {"f_0011.raw", "f_0002.raw", "f_12345.raw", "f_3.raw", "f_0004.raw.gz", "g_0005.raw"})
    writeBytes(folder.path() / name, "x");
  fs::create_directory(folder.path() / "f_0003.raw");  // a folder of slices, say
  const auto frames = listFrames(folder.path() / "f_%04d.raw");
  REQUIRE(frames.size() == 4);
  CHECK(frames[0].number == 2);
  CHECK(frames[1].number == 3);
  CHECK(frames[2].path == folder.path() / "f_0011.raw");
  CHECK(frames[3].number == 12345);
  for (const NumberedFile& frame : frames) CHECK(framePath(folder.path() / "f_%04d.raw", frame.number) == frame.path);
  const auto plain = listFrames(folder.path() / "f_%d.raw");
  REQUIRE(plain.size() == 4);
  CHECK(plain[1].path == folder.path() / "f_3.raw");
  CHECK_THAT(complaint<IoError>([&] { listFrames(folder.path() / "h_%d.raw"); }),
             Contains("h_%d.raw: expected files of that pattern, found none"));
  CHECK_THAT(complaint<IoError>([&] { listFrames(folder.path() / "none" / "h_%d.raw"); }),
             Contains("none: cannot read: "));
  CHECK_THAT(complaint<InvalidArgument>([&] { listFrames("a_%d_%d.raw"); }), Contains("found a_%d_%d.raw"));
}

TEST_CASE("A pattern is one number in the name of the file, not in folders or datasets", "[ingest]") {
  const TemporaryFolder folder;
  CHECK(isFramePattern("a/v_%04d.nrrd"));
  CHECK(isFramePattern("a/v_%d"));
  CHECK(isFramePattern("a/v_%4d.h5:/group/density"));
  CHECK(framePath("a/v_%4d.h5:/group/density", 12) == "a/v_  12.h5:/group/density");
  for (const char* none : {"v.nrrd", "v_%s.nrrd", "%d/v.nrrd", "v_%d_%d.nrrd", "v.h5:/group_%d/density", "v_%-4d"})
    CHECK_FALSE(isFramePattern(none));
  writeBytes(folder.path() / "v_%d.raw", "x");  // a file that is called so
  CHECK_FALSE(isFramePattern(folder.path() / "v_%d.raw"));
  writeBytes(folder.path() / "v_7.h5", "x");
  const auto frames = listFrames(folder.path() / "v_%d.h5:/d");
  REQUIRE(frames.size() == 1);
  CHECK(frames[0].path == folder.path() / "v_7.h5:/d");
}

TEST_CASE("Frames have negative numbers and numbers of several widths, and what shares a number is told", "[ingest]") {
  const TemporaryFolder folder;
  for (const char* name : {"s_-002.npy", "s_-001.npy", "s_0000.npy", "s_0003.npy", "s_9.npy", "s_10.npy", "s_0010.npy",
                           "s_99999999999999999999.npy", "s_x.npy", "s_1-2.npy"})
    writeBytes(folder.path() / name, "x");
  std::vector<fs::path> leftOut;
  const auto frames = listFrames(folder.path() / "s_%04d.npy", &leftOut);
  std::vector<std::int64_t> numbers;
  for (const NumberedFile& frame : frames) numbers.push_back(frame.number);
  CHECK(numbers == std::vector<std::int64_t>{-2, -1, 0, 3, 9, 10});
  CHECK(frames.back().path == folder.path() / "s_0010.npy");
  CHECK(leftOut == std::vector<fs::path>{folder.path() / "s_10.npy", folder.path() / "s_99999999999999999999.npy"});
  CHECK(framePath("o_%04d.vdb", -2) == "o_-002.vdb");  // as printf has it
  CHECK(framePath("o_%4d.vdb", -2) == "o_  -2.vdb");
  CHECK(framePath("o_%d.vdb", -12) == "o_-12.vdb");
}
