// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <exception>
#include <memory>
#include <stdexcept>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/convert_frames.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;

namespace {

void writeFrames(const TemporaryFolder& folder, std::initializer_list<int> numbers) {
  for (const int number : numbers)
    NoisyVolume(static_cast<std::uint64_t>(number)).write(folder, ("v" + std::to_string(number) + ".raw").c_str());
}

// The pattern of the sequence, as its grids are written and read.
FrameSequence framesIn(const TemporaryFolder& folder, const std::optional<FrameRange>& wanted = {}) {
  return findFrames(folder.path() / "v%d.raw", folder.path() / "o%d.vdb", wanted, noisyOptions());
}

}  // namespace

TEST_CASE("Frames become what each is converted to alone, volumes and grids", "[convert]") {
  const TemporaryFolder folder;
  writeFrames(folder, {1, 2, 5});
  ConvertOptions options = noisyOptions();
  options.build.step = 0.5f;
  std::vector<std::int64_t> written;
  const auto same = [&](const FrameFiles& frame, const ConvertReport& report, const ConvertOptions& of) {
    written.push_back(frame.number);
    const auto alone = folder.path() / "alone.vdb";
    const ConvertReport expected = convert({frame.input}, alone, of);
    CHECK(report.output == frame.output);
    CHECK(report.bytesIn == expected.bytesIn);
    CHECK(report.grids.at(0).build.maxError == expected.grids.at(0).build.maxError);
    CHECK(report.grids.at(0).build.activeVoxels == expected.grids.at(0).build.activeVoxels);
    const auto grid = readScalarGrid(frame.output).grid, other = readScalarGrid(alone).grid;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
      const float there = other->tree().getValue(value.getCoord());
      if (*value != there) REQUIRE(*value == there);
    }
  };
  convertFrames(framesIn(folder).frames, options,
                [&](const FrameFiles& frame, const ConvertReport& report) { same(frame, report, options); });
  CHECK(written == std::vector<std::int64_t>{1, 2, 5});

  ConvertOptions ofGrids;
  ofGrids.build.clipBelow = 50;
  const auto grids = findFrames(folder.path() / "o%d.vdb", folder.path() / "p%d.nvdb", FrameRange{2, 9});
  convertFrames(grids.frames, ofGrids,
                [&](const FrameFiles& frame, const ConvertReport& report) { same(frame, report, ofGrids); });
  CHECK(written == std::vector<std::int64_t>{1, 2, 5, 2, 5});
}

TEST_CASE("Grids of frames keep the number of their frame, as text, where they have none", "[convert]") {
  const TemporaryFolder folder;
  writeFrames(folder, {3, 12});
  const auto frameOf = [&](const char* name) { return readScalarGrid(folder.path() / name).metadata("frame"); };
  const auto ignore = [](const FrameFiles&, const ConvertReport&) {};
  convertFrames(framesIn(folder).frames, noisyOptions(), ignore);
  CHECK(frameOf("o3.vdb") == "3");
  CHECK(frameOf("o12.vdb") == "12");
  // Grids that have a number keep it; one that was converted alone has none.
  std::filesystem::rename(folder.path() / "o3.vdb", folder.path() / "o5.vdb");
  convert({folder.path() / "v3.raw"}, folder.path() / "o7.vdb", noisyOptions());
  CHECK(frameOf("o7.vdb").empty());
  convertFrames(findFrames(folder.path() / "o%d.vdb", folder.path() / "p%d.vdb", {}).frames, {}, ignore);
  CHECK(frameOf("p5.vdb") == "3");
  CHECK(frameOf("p7.vdb") == "7");
  CHECK(frameOf("p12.vdb") == "12");
}

TEST_CASE("Frames that are missing are told as ranges of those wanted", "[convert]") {
  const TemporaryFolder folder;
  writeFrames(folder, {1, 2, 5, 9});
  const auto missing = [&](const std::optional<FrameRange>& wanted) {
    std::vector<std::array<std::int64_t, 3>> found;
    for (const FrameRange& gap : framesIn(folder, wanted).missing) found.push_back({gap.first, gap.last, gap.step});
    return found;
  };
  using Gaps = std::vector<std::array<std::int64_t, 3>>;
  CHECK(missing({}) == Gaps{{3, 4, 1}, {6, 8, 1}});
  CHECK(missing(FrameRange{1, 2}) == Gaps{});
  CHECK(missing(FrameRange{1, 15, 4}) == Gaps{{13, 13, 4}});
  CHECK(missing(FrameRange{5, INT64_MAX}) == Gaps{{6, 8, 1}, {10, INT64_MAX, 1}});
  CHECK_THROWS_WITH(framesIn(folder, FrameRange{3, 4}), Contains("expected frames of 3-4, found none"));
  CHECK_THROWS_AS(framesIn(folder, FrameRange{4, 3}), OptionsError);
  CHECK_THROWS_AS(framesIn(folder, FrameRange{1, 3, 0}), OptionsError);
}

TEST_CASE("An error names its frame, keeps what it was, and ends the sequence", "[convert]") {
  const TemporaryFolder folder;
  writeFrames(folder, {1, 2, 3});
  ConvertOptions options = noisyOptions();
  options.progress = [&](const ConvertProgress& now) {
    if (now.input.filename() == "v2.raw") throw std::out_of_range("stopped");
  };
  int written = 0;
  try {
    convertFrames(framesIn(folder).frames, options, [&](const FrameFiles&, const ConvertReport&) { ++written; });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(std::string(error.what()) == "frame 2: stopped");
    CHECK_THROWS_AS(std::rethrow_if_nested(error), std::out_of_range);
  }
  CHECK(written == 1);
  CHECK(std::filesystem::exists(folder.path() / "o1.vdb"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "o2.vdb"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "o3.vdb"));
}
