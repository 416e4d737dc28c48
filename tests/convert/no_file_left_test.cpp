// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <exception>
#include <functional>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

struct Stopped {};  // no exception of ours, so that it is seen to pass through

std::size_t filesIn(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

}  // namespace

TEST_CASE("What progress throws ends a conversion, which leaves no file and spares the old one", "[convert]") {
  const TemporaryFolder folder;
  const auto input = NoisyVolume(21).write(folder, "v.raw");
  for (const ConvertStage stage : {ConvertStage::converting, ConvertStage::verifying})
    for (const char* output : {"out.vdb", "out.nvdb", "out.mhd", "there.vdb"}) {
      CAPTURE(output, int(stage));
      writeBytes(folder.path() / "there.vdb", "old");
      const std::size_t before = filesIn(folder.path());
      ConvertOptions options = noisyOptions();
      options.verify = true;
      options.progress = [&](const ConvertProgress& now) {
        if (now.stage == stage) throw Stopped();
      };
      CHECK_THROWS_AS(convert({input}, folder.path() / output, options), Stopped);
      CHECK(filesIn(folder.path()) == before);
      CHECK(readBytes(folder.path() / "there.vdb") == "old");
    }
}

TEST_CASE("Options that do not fit are refused by their field, and no file is left", "[convert]") {
  const TemporaryFolder folder;
  const auto input = NoisyVolume(22).write(folder, "v.raw");
  const auto refused = [&](const char* output, const char* message, bool options,
                           const std::function<void(ConvertOptions&)>& edit) {
    CAPTURE(output, message);
    const std::size_t before = filesIn(folder.path());
    ConvertOptions edited = noisyOptions();
    edit(edited);
    try {
      convert({input}, folder.path() / output, edited);
      FAIL("not refused");
    } catch (const InvalidArgument& error) {
      CHECK_THAT(error.what(), Contains(message));
      CHECK((dynamic_cast<const OptionsError*>(&error) != nullptr) == options);
    }
    CHECK(filesIn(folder.path()) == before);
  };
  refused("o.txt", "ends in .vdb, .nvdb, .mhd or .nrrd", true, [](ConvertOptions&) {});
  refused("o.nvdb", "output.codec is for .vdb, not for .nvdb", true,
          [](ConvertOptions& o) { o.output.codec = VdbCodec::zip; });
  refused("o.vdb", "output.nano is for .nvdb, not for .vdb", true,
          [](ConvertOptions& o) { o.output.nano = NanoOptions{NanoValues::bits8}; });
  refused("o.nvdb", "output.nano adaptive: expected a build.maxError", true,
          [](ConvertOptions& o) { o.output.nano = NanoOptions{NanoValues::adaptive}; });
  refused("o.nvdb", "output.nano bits8: expected no build.maxError", true, [](ConvertOptions& o) {
    o.output.nano = NanoOptions{NanoValues::bits8};
    o.build.maxError = 1.0f;
  });
  refused("o.vdb", "options.names: expected one for each of 1 inputs, found 2", true, [](ConvertOptions& o) {
    o.names = {"a", "b"};
  });
  refused("o.vdb", "dims", true, [](ConvertOptions& o) { o.source.open.raw->dims.x = 0; });  // of openVolume
  refused("o.vdb", "crop", false, [](ConvertOptions& o) { o.source.crop = IndexBox{{0, 0, 0}, {24, 1, 1}}; });
  refused("o.vdb", "expected a value that the volume crosses", false,
          [](ConvertOptions& o) { o.isosurface = IsosurfaceOptions{101}; });
}

// A caller that knows what to do about an error of a reader finds it.
TEST_CASE("The error of a reader is nested in that of the options", "[convert]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "unknown", "no format begins like this");
  try {
    convert({folder.path() / "unknown"}, folder.path() / "o.vdb");
    FAIL("not refused");
  } catch (const OptionsError& error) {
    try {
      std::rethrow_if_nested(error);
      FAIL("nothing nested");
    } catch (const InvalidArgument& cause) {
      CHECK(std::string(cause.what()) == error.what());
    }
  }
}
