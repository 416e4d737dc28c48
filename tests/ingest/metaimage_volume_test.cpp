// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/metaimage_volume.h"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <random>

#include "ingest/small_volume.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

struct MetaFile {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.mha";
  void write(const std::string& header, const std::string& data = {}) const { writeBytes(path, header + data); }
  void beside(const std::string& name, const std::string& bytes) const { writeBytes(folder.path() / name, bytes); }
  std::vector<float> read() const { return readVolume(*openMetaImage(path)); }
};

const std::string kMetaStart = "ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementType = MET_SHORT\n";
const std::string kLocal = "ElementDataFile = LOCAL\n";

}  // namespace

TEST_CASE("MetaImage voxels of every kind of storage are the same", "[ingest]") {
  const MetaFile file;
  const std::string little = bytesOf(kValues), big = bytesOf(kValues, true);
  file.write(kMetaStart + "BinaryData = True\n" + kLocal, little);
  CHECK(file.read() == kFloats);
  file.write(kMetaStart + "BinaryDataByteOrderMSB = True\n" + kLocal, big);
  CHECK(file.read() == kFloats);
  file.write(kMetaStart + "ElementByteOrderMSB = True\r\nCompressedData = True\r\nElementDataFile = LOCAL\n",
             zlibPacked(big));
  CHECK(file.read() == kFloats);
  file.write(kMetaStart + "BinaryData = False\n" + kLocal, "0 1 2 3 4 5 -6 -7 -8 -9 -300 32767\n");
  CHECK(file.read() == kFloats);
  file.beside("a b.raw", "xyz" + little);
  file.write(kMetaStart + "HeaderSize = 3\nElementDataFile = a b.raw\n");
  CHECK(file.read() == kFloats);
  file.write(kMetaStart + "HeaderSize = -1\nElementDataFile = a b.raw\n");
  CHECK(file.read() == kFloats);
  file.beside("s08.raw", little.substr(0, 12));
  file.beside("s10.raw", little.substr(12));
  file.write(kMetaStart + "ElementDataFile = s%02d.raw 8 10 2\n");
  CHECK(file.read() == kFloats);
  file.write(kMetaStart + "ElementDataFile = LIST\ns08.raw\ns10.raw\n");
  CHECK(file.read() == kFloats);
  file.beside("s08.raw", zlibPacked(little.substr(0, 12)));
  file.beside("s10.raw", zlibPacked(little.substr(12)));
  file.write(kMetaStart + "CompressedData = True\nElementDataFile = LIST 2D\ns08.raw\ns10.raw\n");
  CHECK(file.read() == kFloats);
}

TEST_CASE("A MetaImage data file may be called list", "[ingest]") {
  const MetaFile file;
  file.beside("list_1.raw", bytesOf(kValues));
  file.write(kMetaStart + "ElementDataFile = list_1.raw\n");
  CHECK(file.read() == kFloats);
}

TEST_CASE("A row of TransformMatrix is an axis of a MetaImage, and units become mm", "[ingest]") {
  const MetaFile file;
  file.write(kMetaStart +
                 "TransformMatrix = 0 1 0 -1 0 0 0.5 0 1\nOffset = 10 -20 0.1\nCenterOfRotation = 5 5 5\n"
                 "ElementSpacing = 0.7 0.8 1.5\nDistanceUnits = um\nModality = MET_MOD_CT\n"
                 "AnatomicalOrientation = RAI\n" +
                 kLocal,
             bytesOf(kValues));
  const VolumeInfo info = openMetaImage(file.path)->info();
  const glm::dmat4 microns(0, 0.7, 0, 0, -0.8, 0, 0, 0, 0.75, 0, 1.5, 0, 10, -20, 0.1, 1);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      CHECK(info.indexToWorld[column][row] == Approx(1e-3 * microns[column][row]).epsilon(1e-15));
  CHECK(info.metadata.at("space") == "LPS");
  CHECK(info.metadata.at("modality") == "CT");
  CHECK(info.metadata.at("length_unit") == "mm");
  CHECK(info.metadata.at("source_format") == "MetaImage");
  CHECK(info.metadata.at("source_file") == "v.mha");
  file.write(kMetaStart + "ElementToIntensityFunctionSlope = 0.5\nElementToIntensityFunctionOffset = -1000\n" + kLocal,
             bytesOf(kValues));
  CHECK(file.read()[10] == -1150);
}

TEST_CASE("Malformed MetaImage is refused with the field and both values", "[ingest]") {
  const MetaFile file;
  const auto refused = [&](const std::string& header, const std::string& what) {
    file.write(header, bytesOf(kValues));
    CHECK_THROWS_AS(file.read(), IoError);
    CHECK_THROWS_WITH(file.read(), Contains(what) && Contains(file.folder.path().string()));
  };
  refused("ObjectType = Tube\n" + kLocal, "ObjectType: expected Image, found \"tube\"");
  refused(kMetaStart, "header: expected");  // the voxels are read as text
  refused(kMetaStart + "ElementSpacing = 1 0 1\n" + kLocal, "ElementSpacing: expected numbers other than 0");
  refused(kMetaStart + "ElementSpacing = 1 nan 1\n" + kLocal, "ElementSpacing: expected 3 finite numbers");
  refused(kMetaStart + "Offset = 1 2\n" + kLocal, "Offset: expected 3 finite numbers, found \"1 2\"");
  refused(kMetaStart + "TransformMatrix = 1 0 0 1 0 0 0 0 1\n" + kLocal, "three independent directions");
  refused(kMetaStart + "ElementNumberOfChannels = 0\n" + kLocal, "ElementNumberOfChannels: expected 1 to 65536");
  refused(kMetaStart + "ElementType = MET_OTHER\n" + kLocal, "found \"MET_OTHER\"");
  refused(kMetaStart + "DimSize = 2 3 1e12\n" + kLocal, "DimSize: expected numbers from 1");
  refused(kMetaStart + "DimSize = 2147483647 2147483647 2147483647\n" + kLocal, "less than 2^63");
  refused(kMetaStart + "DimSize = 2 3 3\n" + kLocal, "expected 36 bytes of i16 voxels, found 24");
  refused(kMetaStart + "NDims = 5\nDimSize = 2 3 2 1 5\n" + kLocal, "a volume of two or three axes, and one of frames");
  refused(kMetaStart + "ElementDataFile = none.raw\n", "none.raw: no such file");
  refused(kMetaStart + "CompressedData = True\n" + kLocal, "cannot unpack zlib");
  refused("ObjectType = Image\nNDims = 3\nDimSize = 99999 99999 9\nElementType = MET_UCHAR\nCompressedData = True\n" +
              kLocal,
          "cannot hold more than");
}

TEST_CASE("MetaImage headers with flipped bytes end in a volume or an IoError", "[ingest]") {
  const MetaFile file;
  const std::string good = kMetaStart +
                           "ElementSpacing = 1 1 2\nOffset = 0 0 0\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n" + kLocal +
                           bytesOf(kValues);
  std::mt19937 random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 1 + trial % 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    writeBytes(file.path, bytes);
    try {
      file.read();
    } catch (const IoError&) {
    }
  }
}
