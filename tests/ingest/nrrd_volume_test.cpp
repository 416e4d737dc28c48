// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/nrrd_volume.h"
#include "umbrick/ingest/open_volume.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "ingest/small_volume.h"
#include "support/files.h"
#include "support/packed.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

struct NrrdFolder {
  TemporaryFolder folder;
  fs::path path = folder.path() / "v.nrrd";
  void write(const std::string& header, const std::string& data = {}) const { writeBytes(path, header + data); }
  void beside(const std::string& name, const std::string& bytes) const { writeBytes(folder.path() / name, bytes); }
  std::vector<float> read() const {
    const auto source = openNrrd(path);
    const glm::i64vec3 dims = source->info().dims;
    std::vector<float> out(static_cast<std::size_t>(dims.x * dims.y * dims.z));
    source->readSlab(dims.z, out);
    return out;
  }
};

const std::string kNrrdStart = "NRRD0004\n# a comment\ndimension: 3\nsizes: 2 3 2\ntype: short\n";

}  // namespace

TEST_CASE("NRRD encodings give the same voxels", "[ingest]") {
  const NrrdFolder file;
  const std::string little = bytesOf(kValues), big = bytesOf(kValues, true);
  file.write(kNrrdStart + "endian: little\nencoding: raw\n\n", little);
  CHECK(file.read() == kFloats);
  file.write(kNrrdStart + "endian: big\r\nencoding: raw\r\n\r\n", big);
  CHECK(file.read() == kFloats);
  file.write(kNrrdStart + "endian: big\nencoding: gzip\nbyte skip: 3\n\n", gzipped("abc" + big));
  CHECK(file.read() == kFloats);
  file.write(kNrrdStart + "endian: little\nencoding: bzip2\n\n", bzip2Packed(little));
  CHECK(file.read() == kFloats);
  file.write(kNrrdStart + "encoding: text\n\n", "0 1 2 3 4 5\n-6, -7 -8 +-9 0 0\n");
  CHECK_THROWS_WITH(file.read(), Contains("voxel 9") && Contains("+-9"));
  file.write(kNrrdStart + "encoding: ascii\n\n", "0 1 +2 3 4 5\n-6, -7 -8 -9 -300\n3.2767e4\n");
  CHECK(file.read() == kFloats);
  std::string hex;
  for (const char c : little) {
    const char digits[] = "0123456789aBcDeF";
    hex += {digits[static_cast<unsigned char>(c) >> 4], digits[c & 15], ' '};
  }
  file.write(kNrrdStart + "endian: little\nencoding: hex\n\n", hex);
  CHECK(file.read() == kFloats);
}

TEST_CASE("NRRD data may lie in other files", "[ingest]") {
  const NrrdFolder file;
  const std::string bytes = bytesOf(kValues), half1 = bytes.substr(0, 12), half2 = bytes.substr(12);
  const std::string start = kNrrdStart + "endian: little\nencoding: raw\n";
  file.beside("one.raw", "skipped\nlines\nxy" + bytes);
  file.write(start + "line skip: 2\nbyte skip: 2\ndata file: one.raw\n");
  CHECK(file.read() == kFloats);
  file.write(start + "byteskip: -1\ndatafile: one.raw\n");
  CHECK(file.read() == kFloats);
  file.beside("a.raw", half1);
  file.beside("b c.raw", half2);
  file.write(start + "data file: LIST\na.raw\nb c.raw\n");
  CHECK(file.read() == kFloats);
  file.beside("s07.raw", half1);
  file.beside("s10.raw", half2);
  file.write(start + "data file: s%02d.raw 7 10 3\n");
  CHECK(file.read() == kFloats);
  file.write(start + "data file: s%02d.raw 10 7 -3\n");
  CHECK(file.read().front() == -6);
  file.write(start + "data file: s%02d.raw 1 3 1\n");
  CHECK_THROWS_WITH(file.read(), Contains("s01.raw: no such file"));
  file.write(start + "data file: s%n%d.raw 1 3 1\n");
  CHECK_THROWS_WITH(file.read(), Contains("data file: expected a pattern"));
}

TEST_CASE("A NRRD data file may be called list, and the fields behind its name count", "[ingest]") {
  const NrrdFolder file;
  file.beside("list_1.raw", bytesOf(kValues));
  file.write(kNrrdStart + "endian: little\nencoding: raw\ndata file: list_1.raw\nspacings: 2 3 4\n");
  CHECK(file.read() == kFloats);
  CHECK(openNrrd(file.path)->info().indexToWorld == glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1));
}

TEST_CASE("NRRD geometry is taken as the file states it", "[ingest]") {
  const NrrdFolder file;
  const std::string start = kNrrdStart + "endian: little\nencoding: raw\n", data = "\n" + bytesOf(kValues);
  file.write(start + "spacings: 0.5 nan 2\naxis mins: 10 20 30\ncenterings: node cell cell\n", data);
  CHECK(openNrrd(file.path)->info().indexToWorld == glm::dmat4(0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 10, 20.5, 31, 1));
  file.write(start +
                 "space: left-posterior-superior\nspace directions: (1,0,0) (0, -2, 0) (0.5,0,3)\n"
                 "space origin: (-1,2,-3.5)\nkey:=some value\ncontent: head\n",
             data);
  const VolumeInfo info = openNrrd(file.path)->info();
  CHECK(info.indexToWorld == glm::dmat4(1, 0, 0, 0, 0, -2, 0, 0, 0.5, 0, 3, 0, -1, 2, -3.5, 1));
  CHECK(info.metadata.at("nrrd_space") == "left-posterior-superior");
  CHECK(info.metadata.at("nrrd_content") == "head");
  CHECK(info.metadata.at("key") == "some value");
  CHECK(info.metadata.at("space") == "LPS");
  CHECK(info.metadata.at("source_format") == "NRRD");
  file.write(start +
                 "space: RAS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\n"
                 "space units: \"um\" \"mm\" \"m\"\n",
             data);
  CHECK(openNrrd(file.path)->info().indexToWorld ==
        glm::dmat4(1e-3, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3000, 0, 1e-3, 2, 3000, 1));
  file.write(start + "spacings: 1 2 3\nunits: \"cm\" \"cm\" \"mm\"\n", data);
  CHECK(openNrrd(file.path)->info().indexToWorld == glm::dmat4(10, 0, 0, 0, 0, 20, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1));
}

TEST_CASE("NRRD axes that are not of space are dropped when they hold one thing", "[ingest]") {
  const NrrdFolder file;
  const std::string end = "type: uchar\nencoding: raw\n";
  file.write("NRRD0005\ndimension: 4\nsizes: 1 2 3 2\nspace: RAS\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n" +
                 end + "\n",
             "abcdefghijkl");
  CHECK(openNrrd(file.path)->info().dims == glm::i64vec3(2, 3, 2));
  file.write("NRRD0005\ndimension: 4\nsizes: 3 2 2 1\nkinds: RGB-color domain domain domain\n" + end + "\n",
             "abcdefghijkl");
  CHECK_THROWS_AS(file.read(), SeveralParts);
  CHECK_THROWS_WITH(file.read(), Contains("voxels of 3 numbers, component 0 to 2"));
  file.write("NRRD0005\ndimension: 2\nsizes: 4 3\nspacings: 2 3\n" + end + "\n", "abcdefghijkl");
  CHECK(openNrrd(file.path)->info().dims == glm::i64vec3(4, 3, 1));
}

TEST_CASE("Malformed NRRD is refused with the field, what was expected and what was found", "[ingest]") {
  const NrrdFolder file;
  const std::string data = bytesOf(kValues);
  const auto refused = [&](const std::string& header, const std::string& what) {
    file.write(header + "\n", data);
    CHECK_THROWS_AS(file.read(), IoError);
    CHECK_THROWS_WITH(file.read(), Contains(what) && Contains(file.folder.path().string()));
  };
  const std::string raw = "endian: little\nencoding: raw\n";
  refused("PNG\n", "first line: expected NRRD0001");
  refused("NRRD0004\ndimension 3\n", "\"field: value\"");
  refused("NRRD0004\n" + raw, "type: expected the field, found nothing");
  refused(kNrrdStart + "encoding: raw\n", "endian: expected little or big");
  refused(kNrrdStart + "endian: middle\nencoding: raw\n", "found \"middle\"");
  refused(kNrrdStart + "endian: little\nencoding: bzip2\n", "no bzip2 magic");
  refused(kNrrdStart + "endian: little\nencoding: lzma\n",
          "encoding: expected raw, gzip, bzip2, text or hex, found \"lzma\"");
  refused("NRRD0004\ndimension: 3\nsizes: 2 3\ntype: short\n" + raw, "sizes: expected 3 values, found \"2 3\"");
  refused("NRRD0004\ndimension: 3\nsizes: 2 -3 2\ntype: short\n" + raw, "sizes: expected numbers from 1");
  refused("NRRD0004\ndimension: 3\nsizes: 2147483647 2147483647 2147483647\ntype: short\n" + raw,
          "less than 2^63 bytes");
  refused("NRRD0004\ndimension: 3\nsizes: 2 3 2\ntype: block\n" + raw, "found \"block\"");
  refused("NRRD0004\ndimension: 3\nsizes: 2 3 2\ntype: int128\n" + raw, "found \"int128\"");
  refused("NRRD0004\ndimension: 99999999999999999999\nsizes: 2 3 2\ntype: short\n" + raw, "dimension");
  refused(kNrrdStart + raw + "spacings: 1 0 1\n", "spacings: expected positive finite numbers");
  refused(kNrrdStart + raw + "space: LPS\nspace directions: (1,0,0) (2,0,0) (0,0,1)\n", "independent directions");
  refused(kNrrdStart + raw + "space: LPS\nspace directions: (1,0,0) (0,1) (0,0,1)\n", "a vector of 3 finite numbers");
  refused(kNrrdStart + raw + "space directions: (1,0,0) (0,1,0) (0,0,1)\n", "space: expected the field");
  refused(kNrrdStart + raw + "byte skip: -2\n", "byte skip: expected a number from -1");
  refused(kNrrdStart + raw + "type: short\n", "the field once");
  refused("NRRD0004\ndimension: 3\nsizes: 2 3 3\ntype: short\n" + raw, "expected 36 bytes of i16 voxels, found 24");
  refused(kNrrdStart + "endian: little\nencoding: gzip\n", "no gzip magic");
  refused(kNrrdStart + raw + "data file: none.raw\n", "none.raw: no such file");
}

// Bytes of a header changed at random: an error or a volume, never a crash.
TEST_CASE("NRRD headers with flipped bytes end in a volume, an IoError or a choice of parts", "[ingest]") {
  const NrrdFolder file;
  const std::string good = kNrrdStart +
                           "endian: little\nencoding: raw\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                           "space origin: (0,0,0)\nkinds: domain domain domain\n\n" +
                           bytesOf(kValues);
  std::mt19937 random(11);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 1 + trial % 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    file.write(bytes);
    try {
      file.read();
    } catch (const IoError&) {
    } catch (const SeveralParts&) {
    }
  }
}

TEST_CASE("Bytes behind the voxels of a header's own file are told, or refused", "[ingest]") {
  const TemporaryFolder folder;
  const std::string voxels(8, '\3');
  const auto nrrd = folder.path() / "v.nrrd", mha = folder.path() / "v.mha";
  for (const int more : {0, 5}) {
    writeBytes(nrrd, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n" + voxels +
                         std::string(static_cast<std::size_t>(more), 'x'));
    writeBytes(mha, "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + voxels +
                        std::string(static_cast<std::size_t>(more), 'x'));
    for (const auto& path : {nrrd, mha}) {
      CAPTURE(path, more);
      const auto source = openVolume(path);
      std::vector<float> slab(8);
      source->readSlab(2, slab);
      CHECK(slab == std::vector<float>(8, 3));
      REQUIRE(source->info().notes.size() == (more > 0 ? 1u : 0u));
      if (more == 0) continue;
      CHECK_THAT(source->info().notes[0], Contains("5 bytes behind its voxels"));
      OpenOptions strict;
      strict.strict = true;
      CHECK_THROWS_AS(openVolume(path, strict), IoError);
    }
  }
}
