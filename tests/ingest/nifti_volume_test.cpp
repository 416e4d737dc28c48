// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/nifti_volume.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>

#include "ingest/small_volume.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// A header by the byte offsets of the standard (nifti1.h, nifti2.h), in either byte order.
class Header {
 public:
  explicit Header(int version = 1, bool big = false) : bytes_(version == 1 ? 352 : 544, '\0'), big_(big) {
    if (version == 1) {
      put<std::int32_t>(0, {348});
      put<std::int16_t>(40, {3, 2, 3, 2, 1, 1, 1, 1});
      put<std::int16_t>(70, {4, 16});  // int16
      put<float>(76, {1, 1, 1, 1});
      put<float>(108, {352});
      bytes_.replace(344, 4, "n+1", 4);
    } else {
      put<std::int32_t>(0, {540});
      bytes_.replace(4, 8, std::string("n+2\0\r\n\x1a\n", 8));
      put<std::int16_t>(12, {4, 16});
      put<std::int64_t>(16, {3, 2, 3, 2, 1, 1, 1, 1});
      put<double>(104, {1, 1, 1, 1});
      put<std::int64_t>(168, {544});
    }
  }
  template <class T>
  Header& put(std::size_t at, const std::vector<T>& values) {
    bytes_.replace(at, values.size() * sizeof(T), bytesOf(values, big_));
    return *this;
  }
  Header& text(std::size_t at, const std::string& value) {
    bytes_.replace(at, value.size(), value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_;
};

struct NiftiFile {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.nii";
  void write(const Header& header, const std::string& data = bytesOf(kValues)) const {
    writeBytes(path, header.bytes() + data);
  }
  VolumeInfo info() const { return openNifti(path)->info(); }
};

void checkMatrix(const glm::dmat4& found, const glm::dmat4& expected) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      CHECK(found[column][row] == Approx(expected[column][row]).epsilon(1e-12).margin(1e-12));
}

}  // namespace

TEST_CASE("NIfTI-1, NIfTI-2 and Analyze voxels in every kind of storage are the same", "[ingest]") {
  const NiftiFile file;
  for (const int version : {1, 2})
    for (const bool big : {false, true}) {
      CAPTURE(version, big);
      const std::string voxels = bytesOf(kValues, big);
      file.write(Header(version, big), voxels);
      CHECK(readVolume(*openNifti(file.path)) == kFloats);
      const auto packed = file.folder.path() / "p.nii.gz";
      writeBytes(packed, gzipped(Header(version, big).bytes() + voxels));
      CHECK(readVolume(*openNifti(packed)) == kFloats);
    }
  for (const bool analyze : {false, true}) {
    Header pair;
    pair.put<float>(108, {0}).text(344, analyze ? std::string(4, '\0') : std::string("ni1\0", 4));
    writeBytes(file.folder.path() / "a.hdr", pair.bytes().substr(0, 348));
    writeBytes(file.folder.path() / "a.img", bytesOf(kValues));
    for (const char* name : {"a.hdr", "a.img"}) {
      const auto source = openNifti(file.folder.path() / name);
      CHECK(source->info().metadata.at("source_format") == (analyze ? "Analyze" : "NIfTI"));
      CHECK(readVolume(*source) == kFloats);
    }
  }
}

TEST_CASE("NIfTI slope and intercept are applied once", "[ingest]") {
  const NiftiFile file;
  file.write(Header().put<float>(112, {0.5f, -1000}));
  const auto source = openNifti(file.path);
  CHECK(source->info().metadata.at("rescale") == "-1000 + 0.5 * stored");
  CHECK_FALSE(source->storedType());  // what is stored is not the value
  CHECK(readVolume(*source)[10] == -1150);
}

TEST_CASE("A NIfTI sform that spans no space gives way to a good qform, with a note", "[ingest]") {
  const NiftiFile file;
  Header header;
  header.put<std::int16_t>(252, {1, 1}).put<float>(76, {1, 2, 3, 4}).put<float>(268, {10, 20, 30});
  file.write(header);
  checkMatrix(file.info().indexToWorld, glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
  CHECK(file.info().notes ==
        std::vector<std::string>{"the sform (code 1) has no three independent directions: the qform is used"});
  header.put<float>(76, {1, 0, 3, 4});  // no better
  file.write(header);
  CHECK_THROWS_WITH(file.info(), Contains("sform: expected finite numbers and three independent directions"));
}

TEST_CASE("NIfTI places voxels by the sform, else the qform, else pixdim, in mm and RAS", "[ingest]") {
  const NiftiFile file;
  // The sform is any matrix; in metres here.
  Header header;
  header.put<float>(280, {-2, 0.5f, 0, 10, 0, 3, 0.25f, -20, 0, 0, 4, 30})
      .put<std::int16_t>(252, {1, 2})
      .put<char>(123, {1});
  file.write(header);
  checkMatrix(file.info().indexToWorld,
              1000.0 * glm::dmat4(-2, 0, 0, 0, 0.5, 3, 0, 0, 0, 0.25, 4, 0, 10, -20, 30, 1e-3));
  CHECK(file.info().metadata.at("space") == "RAS");
  CHECK(file.info().metadata.at("length_unit") == "mm");
  // The qform: a rotation, and pixdim[0] = -1 mirrors the third axis.
  const double b = 0.25, c = -0.5, d = 0.125, a = std::sqrt(1 - b * b - c * c - d * d);
  Header rotated;
  rotated.put<std::int16_t>(252, {1, 0})
      .put<float>(76, {-1, 0.5f, 0.75f, 2})
      .put<float>(256, {float(b), float(c), float(d), 1, 2, 3});
  rotated.put<char>(123, {3});  // microns
  file.write(rotated);
  glm::dmat4 expected(glm::mat3_cast(glm::dquat(a, b, c, d)));
  expected[0] *= 0.5;
  expected[1] *= 0.75;
  expected[2] *= -2;
  expected[3] = glm::dvec4(1, 2, 3, 1);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) expected[column][row] *= 1e-3;
  checkMatrix(file.info().indexToWorld, expected);
  // Neither: voxels pixdim apart, no space known. NIfTI-2 keeps doubles.
  file.write(Header(2).put<double>(104, {1, 0.1, 0.2, 0.3}));
  checkMatrix(file.info().indexToWorld, glm::dmat4(0.1, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 1));
  CHECK(file.info().metadata.count("space") == 0);
}

TEST_CASE("What follows the voxels of NIfTI is left out with a note, unless strict", "[ingest]") {
  const NiftiFile file;
  file.write(Header(), bytesOf(kValues) + "0123456");
  const auto source = openNifti(file.path);
  REQUIRE_FALSE(source->info().notes.empty());
  CHECK(source->info().notes.back() ==
        "v.nii has 31 bytes of voxels for 2 x 3 x 2 i16 = 24 bytes: the last 7 are left out");
  CHECK(readVolume(*source) == kFloats);
  CHECK_THROWS_WITH(openNifti(file.path, {}, false, true),
                    Contains("expected 2 x 3 x 2 i16 = 24 bytes after a header of 352, found 31"));
}

TEST_CASE("Malformed NIfTI is refused with the field and both values", "[ingest]") {
  const NiftiFile file;
  const auto refused = [&](const Header& header, const std::string& what) {
    file.write(header);
    CHECK_THROWS_AS(readVolume(*openNifti(file.path)), IoError);
    CHECK_THROWS_WITH(readVolume(*openNifti(file.path)), Contains(what) && Contains(file.path.string()));
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refused(Header().put<float>(80, {1, 0, 1}), "pixdim[2]: expected a positive finite number, found 0");
  refused(Header().put<float>(80, {1, 1, nan}), "pixdim[3]: expected a positive finite number, found nan");
  refused(Header().put<std::int16_t>(254, {1}).put<float>(280, {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}),
          "sform: expected");
  refused(Header().put<std::int16_t>(254, {1}).put<float>(280, {nan, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}),
          "sform: expected");
  refused(Header().put<std::int16_t>(40, {6, 2, 3, 2, 1, 1, 5}),
          "dim[6]: expected 1, since two axes beside those of space are read, found \"5\"");
  refused(Header().put<std::int16_t>(70, {1536, 128}),
          "datatype: expected integers of 8 to 64 bits, floats, colours or complex numbers, found \"floats of 128 bits "
          "(code 1536)\"");
  refused(Header().put<std::int16_t>(46, {3}), "expected 2 x 3 x 3 i16 = 36 bytes after a header of 352, found 24");
  refused(Header(2).put<std::int64_t>(24, {2147483647, 2147483647, 2147483647}), "dim: expected less than 2^63 bytes");
  refused(Header(2).put<std::int64_t>(24, {std::int64_t(1) << 40}), "dim");
  refused(Header().put<std::int16_t>(42, {-2}), "dim[1]: expected a number from 1 to 2147483647, found \"-2\"");
  refused(Header().put<std::int16_t>(40, {0}), "dim[0]: expected 2 to 7");
  refused(Header().put<std::int32_t>(0, {349}), "header: expected one of NIfTI-1");
  refused(Header().put<float>(108, {1e9f}), "bytes after a header of 1000000000, found 0");
  CHECK_THROWS_WITH(openNifti(file.folder.path() / "none.nii"), Contains("none.nii: no such file"));
}

TEST_CASE("NIfTI headers with flipped bytes end in a volume or an IoError", "[ingest]") {
  const NiftiFile file;
  std::mt19937 random(13);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bytes = Header(1 + trial % 2).bytes() + bytesOf(kValues);
    for (int i = 0; i < 1 + trial % 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    writeBytes(file.path, bytes);
    try {
      readVolume(*openNifti(file.path));
    } catch (const IoError&) {
    }
  }
}

TEST_CASE("Frames, vectors, colours and complex numbers of NIfTI are told apart", "[ingest]") {
  const NiftiFile file;
  const auto open = [&](const Header& header, const std::string& data, const PartChoice& parts) {
    writeBytes(file.path, header.bytes() + data);
    return openNifti(file.path, parts);
  };
  PartChoice all;
  all.allComponents = true;
  PartChoice second = all;
  second.frame = 1;
  // Two frames of vectors: the components are the slowest axis, and frames the one before.
  const auto vectors = open(Header().put<std::int16_t>(40, {5, 1, 1, 1, 2, 3}).put<std::int16_t>(68, {1007}),
                            bytesOf(std::vector<std::int16_t>{10, 20, 11, 21, 12, 22}), second);
  CHECK(vectors->info().frames == 2);
  CHECK(vectors->info().meaning == VoxelMeaning::vector);
  std::vector<float> voxel(3);
  vectors->readSlab(1, voxel);
  CHECK(voxel == std::vector<float>{20, 21, 22});
  // Colours are never scaled.
  const auto colours =
      open(Header().put<std::int16_t>(40, {3, 1, 1, 1}).put<std::int16_t>(70, {128, 24}).put<float>(112, {2, 5}),
           "\1\2\3", all);
  CHECK(colours->info().meaning == VoxelMeaning::colour);
  colours->readSlab(1, voxel);
  CHECK(voxel == std::vector<float>{1, 2, 3});
  const auto complex = open(Header().put<std::int16_t>(40, {3, 1, 1, 1}).put<std::int16_t>(70, {32, 64}),
                            bytesOf(std::vector<float>{0.5f, -2}), all);
  std::vector<float> number(2);
  complex->readSlab(1, number);
  CHECK(number == std::vector<float>{0.5f, -2});
  CHECK_THROWS_AS(open(Header().put<std::int16_t>(40, {4, 1, 1, 1, 2}), "abcd", {}), SeveralParts);
}
