// A volume streams: what a conversion holds is the result and two slabs, whatever the size of the volume.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "support/sanitized.h"
#include "tools/program.h"

using namespace umbrick;
namespace fs = std::filesystem;

namespace {

// 1024 x 1024 x 256 of u16, 512 MiB: 0 but for a block of 224 x 224 x 56 in the middle, 1 % of it. Layers of 8 slices,
// as the slabs that are read, of which 7 have a part of the block.
constexpr std::int64_t kEdge = 1024, kSlices = 256, kLayer = 8, kBlock = 224, kFirstLayer = 12, kBlockLayers = 7;
constexpr std::int64_t kLayerBytes = kEdge * kEdge * kLayer * 2;

// Row y of slice z of the block; no two leaves are alike.
std::vector<std::uint16_t> blockRow(std::int64_t y, std::int64_t z) {
  std::vector<std::uint16_t> row(kBlock);
  for (std::int64_t x = 0; x < kBlock; ++x)
    row[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(1 + (x * 7919 + y * 104729 + z * 1299709) % 60000);
  return row;
}

// Calls put(offset in the layer, row) for all rows of the block in a layer of it.
template <class Put>
void putRows(const Put& put) {
  for (std::int64_t z = 0; z < kLayer; ++z)
    for (std::int64_t y = 0; y < kBlock; ++y) put(((z * kEdge + 400 + y) * kEdge + 400) * 2, blockRow(y, z));
}

void writeSparse(const fs::path& path) {
  { std::ofstream make(path, std::ios::binary); }
  fs::resize_file(path, kSlices / kLayer * kLayerBytes);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  for (std::int64_t layer = kFirstLayer; layer < kFirstLayer + kBlockLayers; ++layer)
    putRows([&](std::int64_t offset, const std::vector<std::uint16_t>& row) {
      file.seekp(layer * kLayerBytes + offset);
      file.write(reinterpret_cast<const char*>(row.data()), kBlock * 2);
    });
}

// The same voxels, each layer a gzip member: two that are packed once.
void writeGzip(const fs::path& path) {
  std::string layer(static_cast<std::size_t>(kLayerBytes), '\0');
  const std::string empty = gzipped(layer);
  putRows([&](std::int64_t offset, const std::vector<std::uint16_t>& row) {
    layer.replace(static_cast<std::size_t>(offset), kBlock * 2, bytesOf(row));
  });
  const std::string filled = gzipped(layer);
  std::ofstream file(path, std::ios::binary);
  for (std::int64_t i = 0; i < kSlices / kLayer; ++i)
    file << (i >= kFirstLayer && i < kFirstLayer + kBlockLayers ? filled : empty);
}

// Runs the program in a folder. @return its peak of resident memory, bytes
std::int64_t peakMemory(const TemporaryFolder& folder, const std::vector<const char*>& arguments, std::string& out) {
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.path().c_str()) != 0) _exit(126);
    const int file = open(".out", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    execv(UMBRICK_PROGRAM, const_cast<char* const*>(arguments.data()));
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  REQUIRE(wait4(child, &status, 0, &usage) == child);
  CHECK(status == 0);
  out = readBytes(folder.path() / ".out");
  return std::int64_t(usage.ru_maxrss) * 1024;
}

}  // namespace

TEST_CASE("A conversion holds the result and two slabs, also of a packed volume", "[tools]") {
  if (kSanitized) {
    WARN("SKIPPED: the address sanitizer has memory of its own");
    return;
  }
  const TemporaryFolder folder;
  writeSparse(folder.path() / "v.raw");
  writeGzip(folder.path() / "v.raw.gz");
  constexpr std::int64_t kResult = (kBlock / 8) * (kBlock / 8) * kBlockLayers * (512 * 4 + 128);  // leaves
  constexpr std::int64_t kSlabs = 2 * kLayerBytes;
  // Code and libraries take what the program does that has nothing to do; stacks and buffers are the rest.
  constexpr std::int64_t kBuffers = std::int64_t(10) << 20;
  std::string version;
  const std::int64_t program = peakMemory(folder, {"umbrick", "--version", nullptr}, version) + kBuffers;
  for (const char* input : {"v.raw", "v.raw.gz"}) {
    std::string out;
    const std::int64_t peak = peakMemory(
        folder, {"umbrick", "convert", input, "--dims", "1024", "1024", "256", "--type", "u16", "-o", "v.vdb", nullptr},
        out);
    CAPTURE(input, peak, program, out);
    CHECK_THAT(out, Catch::Contains("2809856 of 268435456"));
    CHECK(peak < kResult + kSlabs + program);
  }
}
