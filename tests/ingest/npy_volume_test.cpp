// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/npy_volume.h"

#include <catch2/catch.hpp>
#include <limits>

#include "support/files.h"
#include "support/packed.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

struct NpyFile {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.npy";
  static std::string npy(const std::string& descr, const std::string& shape, bool fortran, const std::string& data) {
    std::string text =
        "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
    text += std::string(63 - (10 + text.size()) % 64, ' ') + '\n';
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(text.size()) + '\0' + text + data;
  }
  void write(const std::string& descr, const std::string& shape, bool fortran, const std::string& data) const {
    writeBytes(path, npy(descr, shape, fortran, data));
  }
  std::vector<float> read() const { return readVolume(*openNpy(path)); }
};

template <class T>
void checkType(const NpyFile& file, const std::string& type) {
  const std::vector<T> values{1, 2, 3, T(std::numeric_limits<T>::max() / 2), T(std::numeric_limits<T>::lowest() / 2),
                              0};
  for (const bool big : {false, true}) {
    file.write(std::string(big ? "'>" : "'<") + type + "'", "(3, 1, 2)", false, bytesOf(values, big));
    CHECK(file.read() == std::vector<float>(values.begin(), values.end()));
  }
}

}  // namespace

TEST_CASE("NumPy arrays of every plain type are read in either byte order", "[ingest]") {
  const NpyFile file;
  checkType<std::int8_t>(file, "i1");
  checkType<std::uint16_t>(file, "u2");
  checkType<std::int16_t>(file, "i2");
  checkType<std::uint32_t>(file, "u4");
  checkType<std::int32_t>(file, "i4");
  checkType<std::uint64_t>(file, "u8");
  checkType<std::int64_t>(file, "i8");
  checkType<float>(file, "f4");
  file.write("'|b1'", "(1, 2, 3)", false, std::string("\0\1\1\0\0\1", 6));
  CHECK(file.read() == std::vector<float>{0, 1, 1, 0, 0, 1});
  // 1, -2, 65504 (the largest), 2^-24 (the smallest): IEEE 754 binary16
  file.write("'<f2'", "(1, 2, 2)", false, bytesOf<std::uint16_t>({0x3c00, 0xc000, 0x7bff, 0x0001}));
  CHECK(file.read() == std::vector<float>{1, -2, 65504, 0x1p-24f});
  file.write("'<f8'", "(1, 1, 2)", false, bytesOf<double>({0.5, -1e30}));
  CHECK(file.read() == std::vector<float>{0.5f, -1e30f});
}

TEST_CASE("64-bit integers state what a float loses", "[ingest]") {
  const NpyFile file;
  file.write("'<i8'", "(1, 1, 2)", false, bytesOf<std::int64_t>({(std::int64_t(1) << 62) + 12345, -3}));
  std::vector<float> out(2);
  CHECK(openNpy(file.path)->readSlab(1, out) == 12345);
  CHECK(out[0] == 0x1p62f);
}

TEST_CASE("The fastest axis of a NumPy array is x in either order", "[ingest]") {
  const NpyFile file;
  const std::string data = "abcdef";
  file.write("'|u1'", "(1, 2, 3)", false, data);
  CHECK(openNpy(file.path)->info().dims == glm::i64vec3(3, 2, 1));
  file.write("'|u1'", "(1, 2, 3)", true, data);
  CHECK(openNpy(file.path)->info().dims == glm::i64vec3(1, 2, 3));
  file.write("'|u1'", "(2, 3)", false, data);
  CHECK(openNpy(file.path)->info().dims == glm::i64vec3(3, 2, 1));
  file.write("'|u1'", "(1, 1, 1, 2, 3)", false, data);
  CHECK(openNpy(file.path)->info().dims == glm::i64vec3(3, 2, 1));
  writeBytes(file.path, xzPacked(NpyFile::npy("'|u1'", "(1, 2, 3)", false, data)));
  CHECK(file.read() == std::vector<float>{'a', 'b', 'c', 'd', 'e', 'f'});
}

TEST_CASE("What follows the voxels of a NumPy file is left out with a note, unless strict", "[ingest]") {
  const NpyFile file;
  file.write("'|u1'", "(1, 1, 3)", false, std::string("\1\2\3rest", 7));
  const auto source = openNpy(file.path);
  REQUIRE(source->info().notes.size() == 1);
  CHECK(source->info().notes[0] == "v.npy has 7 bytes of voxels for 3 x 1 x 1 u8 = 3 bytes: the last 4 are left out");
  CHECK(readVolume(*source) == std::vector<float>{1, 2, 3});
  CHECK_THROWS_WITH(openNpy(file.path, {}, true), Contains("= 3 bytes after a header of 128, found 7"));
  // Of a sequence the excess is what stands behind its last volume.
  file.write("'|u1'", "(2, 2, 2, 5)", false, std::string(39, 'a') + "t!");
  PartChoice last;
  last.frame = 1;
  CHECK(readVolume(*openNpy(file.path, last)).back() == 't');
  CHECK_THROWS_AS(openNpy(file.path, last, true), IoError);
  // A packed file tells its size only at its end.
  writeBytes(file.path, gzipped(NpyFile::npy("'|u1'", "(1, 1, 3)", false, "abcd")));
  CHECK_THROWS_WITH(file.read(), Contains("= 3 bytes, found 4"));
}

TEST_CASE("Malformed NumPy files are refused with the field and both values", "[ingest]") {
  const NpyFile file;
  const auto refused = [&](const std::string& descr, const std::string& shape, const std::string& what) {
    file.write(descr, shape, false, "abcdef");
    CHECK_THROWS_AS(file.read(), IoError);
    CHECK_THROWS_WITH(file.read(), Contains(what) && Contains(file.path.string()));
  };
  refused("'<c16'", "(1, 2, 3)", "descr: expected bool");
  refused("[('a', '<f4'), ('b', '<f4')]", "(1, 2, 3)", "descr: expected bool");
  refused("'|u1'", "(6,)", "shape: expected an array of two or three axes, beside which");
  refused("'|u1'", "(1, 2, 0)", "shape: expected a tuple of positive integers");
  refused("'|u1'", "(1, 2, -3)", "shape");
  refused("'|u1'", "(99999999999999999999, 2, 3)", "shape");
  refused("'|u1'", "(2147483647, 2147483647, 2147483647)", "less than 2^63");
  refused("'|u1'", "(2, 2, 3)", "expected 3 x 2 x 2 u8 = 12 bytes after a header of 128, found 6");
  writeBytes(file.path, gzipped(NpyFile::npy("'|u1'", "(100000, 100000, 3)", false, "")));
  CHECK_THROWS_WITH(file.read(), Contains("cannot hold more than"));  // before anything of that size is allocated
  const std::string good = NpyFile::npy("'|u1'", "(1, 2, 3)", false, "abcdef");
  for (std::size_t length = 0; length < good.size(); ++length) {
    writeBytes(file.path, good.substr(0, length));
    CHECK_THROWS_AS(file.read(), IoError);
  }
}
