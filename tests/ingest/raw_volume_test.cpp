// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/raw_volume.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

std::vector<float> readAll(VoxelSource& source, std::int64_t slicesAtOnce, double* error = nullptr) {
  const glm::i64vec3 dims = source.info().dims;
  std::vector<float> out(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (std::int64_t z = 0; z < dims.z; z += slicesAtOnce) {
    const std::int64_t count = std::min(slicesAtOnce, dims.z - z);
    const double slab =
        source.readSlab(count, std::span(out).subspan(static_cast<std::size_t>(z * dims.x * dims.y),
                                                      static_cast<std::size_t>(count * dims.x * dims.y)));
    if (error) *error = std::max(*error, slab);
  }
  return out;
}

template <class T>
std::vector<T> someValues(std::size_t count) {
  std::mt19937 random(5);
  std::vector<T> values(count);
  for (T& value : values)
    value = static_cast<T>(
        std::uniform_real_distribution<double>(static_cast<double>(std::numeric_limits<T>::lowest()) / 2,
                                               static_cast<double>(std::numeric_limits<T>::max()) / 2)(random));
  return values;
}

template <class T>
void checkRoundTrip(VoxelType type) {
  const TemporaryFolder folder;
  const std::vector<T> values = someValues<T>(5 * 3 * 7);
  double expectedError = 0;
  for (const T value : values)
    if (std::isfinite(static_cast<float>(value)))
      expectedError = std::max(expectedError, std::abs(double(value) - double(static_cast<float>(value))));
  for (const bool big : {false, true})
    for (const bool packed : {false, true}) {
      RawOptions options{{5, 3, 7}, type, big ? std::endian::big : std::endian::little, 11};
      const std::string bytes = "header, 11 " + bytesOf(values, big);
      writeBytes(folder.path() / "v.raw", packed ? gzipped(bytes) : bytes);
      for (const std::int64_t slices : {1, 3, 7}) {
        double error = 0;
        const auto source = openRaw(folder.path() / "v.raw", options);
        const std::vector<float> read = readAll(*source, slices, &error);
        for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(read[i] == static_cast<float>(values[i]));
        CHECK(error == expectedError);
      }
    }
}

// As readAll, through readStored.
template <class T>
std::vector<float> readStoredAs(VoxelSource& source) {
  const glm::i64vec3 dims = source.info().dims;
  std::vector<T> stored(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  source.readStored(dims.z, std::as_writable_bytes(std::span(stored)));
  return {stored.begin(), stored.end()};
}

template <class T>
void checkStored(VoxelType type, std::optional<int> bitsStored = {}) {
  const TemporaryFolder folder;
  for (const bool big : {false, true}) {
    writeBytes(folder.path() / "v.raw", bytesOf(someValues<T>(5 * 3 * 7), big));
    RawOptions options{{5, 3, 7}, type, big ? std::endian::big : std::endian::little};
    options.bitsStored = bitsStored;
    const auto source = openRaw(folder.path() / "v.raw", options);
    REQUIRE(source->storedType() == type);
    CHECK(readStoredAs<T>(*source) == readAll(*openRaw(folder.path() / "v.raw", options), 7));
  }
}

}  // namespace

TEST_CASE("Values as stored are those that are read as floats", "[ingest]") {
  checkStored<std::uint8_t>(VoxelType::u8);
  checkStored<std::int8_t>(VoxelType::i8, 5);
  checkStored<std::uint16_t>(VoxelType::u16, 12);
  checkStored<std::int16_t>(VoxelType::i16, 12);
  checkStored<float>(VoxelType::f32);
}

TEST_CASE("Every voxel type comes through in both byte orders, plain and packed", "[ingest]") {
  checkRoundTrip<std::uint8_t>(VoxelType::u8);
  checkRoundTrip<std::int8_t>(VoxelType::i8);
  checkRoundTrip<std::uint16_t>(VoxelType::u16);
  checkRoundTrip<std::int16_t>(VoxelType::i16);
  checkRoundTrip<std::uint32_t>(VoxelType::u32);
  checkRoundTrip<std::int32_t>(VoxelType::i32);
  checkRoundTrip<float>(VoxelType::f32);
}

TEST_CASE("Doubles state what float loses, and never become infinite", "[ingest]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", bytesOf<double>({0.1, 1e300, std::numeric_limits<double>::infinity(), -2.5}));
  double error = 0;
  const auto source = openRaw(folder.path() / "v.raw", {{4, 1, 1}, VoxelType::f64});
  const std::vector<float> read = readAll(*source, 1, &error);
  CHECK(read ==
        std::vector<float>{0.1f, std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity(), -2.5f});
  CHECK(error == 1e300 - static_cast<double>(std::numeric_limits<float>::max()));
}

TEST_CASE("Bits above the stored ones are flags, and signed types extend their sign", "[ingest]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "v.raw";
  writeBytes(path, bytesOf<std::uint16_t>({0x8fff, 0x0800, 0xf7ff, 0x1001}));
  RawOptions options{{4, 1, 1}, VoxelType::u16};
  options.bitsStored = 12;
  CHECK(readAll(*openRaw(path, options), 1) == std::vector<float>{4095, 2048, 2047, 1});
  options.type = VoxelType::i16;
  CHECK(readAll(*openRaw(path, options), 1) == std::vector<float>{-1, -2048, 2047, 1});
  options.bitsStored = 16;
  CHECK(readAll(*openRaw(path, options), 1) == std::vector<float>{-28673, 2048, -2049, 4097});
  options.bitsStored = 1;
  CHECK(readAll(*openRaw(path, options), 1) == std::vector<float>{-1, 0, -1, -1});
}

TEST_CASE("Spacing and origin place voxel centres", "[ingest]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", std::string(6, 'x'));
  RawOptions options{{1, 2, 3}};
  options.spacing = {0.8, 0.7, 1.5};
  options.origin = {-10, 20, 0.25};
  const glm::dmat4 matrix = openRaw(folder.path() / "v.raw", options)->info().indexToWorld;
  CHECK(matrix * glm::dvec4(0, 0, 0, 1) == glm::dvec4(-10, 20, 0.25, 1));
  CHECK(matrix * glm::dvec4(2, 3, 4, 1) == glm::dvec4(-10 + 2 * 0.8, 20 + 3 * 0.7, 0.25 + 4 * 1.5, 1));
}

TEST_CASE("A raw file of the wrong size is refused with both sizes", "[ingest]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "v.raw";
  RawOptions options{{4, 3, 2}, VoxelType::u16};
  writeBytes(path, std::string(47, 'x'));
  CHECK_THROWS_WITH(openRaw(path, options), path.string() + ": expected 4 x 3 x 2 u16 = 48 bytes, found 47");
  writeBytes(path, std::string(48, 'x') + "yy");
  CHECK_THROWS_WITH(openRaw(path, options, {}, true), Contains("= 48 bytes, found 50") && Contains("headerBytes"));
  options.headerBytes = 2;
  CHECK_NOTHROW(openRaw(path, options, {}, true));
  CHECK(openRaw(path, options)->info().notes.empty());
  options.headerBytes = 100;
  CHECK_THROWS_AS(openRaw(path, options), IoError);
}

TEST_CASE("A raw file that is too long is read up to its voxels, with a doubt, unless strict", "[ingest]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "v.raw";
  const std::vector<std::uint16_t> voxels = someValues<std::uint16_t>(24);
  RawOptions options{{4, 3, 2}, VoxelType::u16};
  options.headerBytes = 3;
  writeBytes(path, "abc" + bytesOf(voxels) + "trailing");
  const auto source = openRaw(path, options);
  REQUIRE(source->info().notes.size() == 1);
  CHECK(source->info().notes[0] ==
        "v.raw has 56 bytes of voxels for 4 x 3 x 2 u16 = 48 bytes: the last 8 are left out; does it begin with a "
        "header, or are the dims or the type wrong?");
  CHECK(readAll(*source, 1) == std::vector<float>(voxels.begin(), voxels.end()));
  CHECK_THROWS_WITH(openRaw(path, options, {}, true), Contains("= 48 bytes after a header of 3, found 56"));
}

TEST_CASE("A packed file of the wrong size or cut short is found while reading", "[ingest]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "v.raw.gz";
  const RawOptions options{{4, 3, 2}, VoxelType::u16};
  for (const std::size_t size : {0, 24, 47}) {
    writeBytes(path, gzipped(std::string(size, 'x')));
    CHECK_THROWS_WITH(readAll(*openRaw(path, options), 1), Contains("= 48 bytes, found " + std::to_string(size)));
  }
  writeBytes(path, gzipped(std::string(50, 'x')));
  CHECK_THROWS_WITH(readAll(*openRaw(path, options), 1), Contains("= 48 bytes, found 50"));
  std::string bytes = gzipped(bytesOf(someValues<std::uint16_t>(24)));
  for (std::size_t length = 2; length < bytes.size(); ++length) {
    writeBytes(path, bytes.substr(0, length));
    if (length == 48) continue;  // as long as the voxels: taken for them
    CHECK_THROWS_AS(readAll(*openRaw(path, options), 1), IoError);
  }
  bytes[bytes.size() - 6] ^= 1;  // in the checksum
  writeBytes(path, bytes);
  CHECK_THROWS_WITH(readAll(*openRaw(path, options), 2), Contains("cannot unpack gzip"));
}

TEST_CASE("Impossible raw options are refused before the file is touched", "[ingest]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "none.raw";
  const auto refused = [&](const RawOptions& options, const std::string& what) {
    CHECK_THROWS_AS(openRaw(path, options), InvalidArgument);
    CHECK_THROWS_WITH(openRaw(path, options), Contains(what));
  };
  const RawOptions good{{4, 4, 4}};
  for (const glm::i64vec3 dims : {glm::i64vec3(0, 4, 4), glm::i64vec3(4, -1, 4),
                                  glm::i64vec3(4, 4, std::int64_t(1) << 31), glm::i64vec3(2147483647)}) {
    RawOptions options = good;
    options.dims = dims;
    refused(options, "dims: expected each from 1");
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double spacing : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    RawOptions options = good;
    options.spacing.y = spacing;
    refused(options, "spacing: expected positive finite numbers");
  }
  RawOptions options = good;
  options.origin.z = nan;
  refused(options, "origin");
  options = good;
  options.bitsStored = 9;
  refused(options, "bits stored: expected 1 to 8 for u8, found 9");
  options.type = VoxelType::f32;
  refused(options, "only integers");
  CHECK_THROWS_WITH(openRaw(path, good), Contains("no such file"));
  CHECK_THROWS_WITH(openRaw(folder.path(), good), Contains("found a directory"));
}
