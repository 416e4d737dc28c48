// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <memory>
#include <numeric>

#include "support/files.h"
#include "support/packed.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/ingest/raw_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Opens a file as 2^33 bytes and reads one slice of them, of 2^25 voxels.
void readPromised(const std::filesystem::path& path) {
  const auto source = openRaw(path, RawOptions{{1 << 13, 1 << 12, 1 << 5}, VoxelType::f64});
  constexpr std::size_t kVoxels = std::size_t(1) << 25;
  const auto untouched = std::make_unique_for_overwrite<float[]>(kVoxels);
  source->readSlab(1, {untouched.get(), kVoxels});
}

}  // namespace

TEST_CASE("Every packing gives the same voxels, also in several parts, and says where damage is", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.raw";
  const RawOptions options{{40, 30, 20}, VoxelType::u16};
  std::vector<std::uint16_t> values(40 * 30 * 20);
  std::iota(values.begin(), values.end(), std::uint16_t(7));
  const std::string bytes = bytesOf(values), half1 = bytes.substr(0, 20001), half2 = bytes.substr(20001);
  using Pack = std::string (*)(const std::string&);
  const std::pair<const char*, Pack> packings[] = {
      {"gzip", gzipped}, {"xz", xzPacked}, {"zstd", zstdPacked}, {"bzip2", bzip2Packed}};
  for (const auto& [name, pack] : packings) {
    CAPTURE(name);
    for (const std::string& packed : {pack(bytes), pack(half1) + pack(half2)}) {
      writeBytes(path, packed);
      CHECK(readVolume(*openRaw(path, options)) == std::vector<float>(values.begin(), values.end()));
    }
    const std::string packed = pack(bytes);
    for (const std::size_t length : {packed.size() / 2, packed.size() - 1}) {
      writeBytes(path, packed.substr(0, length));
      CHECK_THROWS_WITH(readVolume(*openRaw(path, options)),
                        Contains(std::string("cannot unpack ") + name + ": the packed data end early"));
    }
    writeBytes(path, pack(bytes + "x"));
    CHECK_THROWS_WITH(readVolume(*openRaw(path, options)), Contains("= 48000 bytes, found 48001"));
    writeBytes(path, pack(half1));
    CHECK_THROWS_WITH(readVolume(*openRaw(path, options)), Contains("= 48000 bytes, found 20001"));
    const std::size_t memory = peakMemoryBytes();
    CHECK_THROWS_WITH(readPromised(path), Contains("= 8589934592 bytes, found "));
    CHECK(peakMemoryBytes() < memory + (std::size_t(1) << 26));
    writeBytes(path, pack(std::string((1 << 24) + 48001, 'x')));
    CHECK_THROWS_WITH(readVolume(*openRaw(path, options)), Contains("= 48000 bytes, found at least 16825216"));
    std::string damaged = packed;
    damaged[damaged.size() / 2] ^= 0x55;
    writeBytes(path, damaged);
    CHECK_THROWS_AS(readVolume(*openRaw(path, options)), IoError);
  }
}
