// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/dicom_volume.h"

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>

#include <catch2/catch.hpp>
#include <random>

#include "ingest/dicom_files.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;

TEST_CASE("A DICOM series is put in order by position, rescaled and placed, tilted or not", "[ingest]") {
  // The second is a gantry tilt: slices move along their columns too, so the volume is sheared.
  for (const glm::dvec3& step : {2.5 * kNormal, 2.5 * kNormal + glm::dvec3(0, 0, -0.5)}) {
    const DicomFolder files;
    files.series(4, step);
    writeBytes(files.folder.path() / "notes.txt", "no DICOM");
    const auto source = files.open();
    checkMatrix(source->info().indexToWorld, step);
    checkVoxels(*source, 4);
    const auto& metadata = source->info().metadata;
    CHECK(metadata.at("space") == "LPS");
    CHECK(metadata.at("modality") == "CT");
    CHECK(metadata.at("value_unit") == "HU");
    CHECK(metadata.at("series_description") == "thorax");
    CHECK(metadata.at("rescale") == "-1000 + 2 * stored");
  }
}

TEST_CASE("DICOM slices that are missing, twice there, out of line or of another kind are named", "[ingest]") {
  const auto with = [](const auto& change, const std::string& what) {
    const DicomFolder files;
    files.series(5, 2.0 * kNormal);
    change(files);
    files.refused(what);
  };
  const glm::dvec3 third = glm::dvec3(1, 2, 3) + 4.0 * kNormal;
  with([](const auto& f) { std::filesystem::remove(f.folder.path() / f.name(2)); },
       "found 4.000000 mm between i8.dcm at (-0.2 3.6 3) and i6.dcm at (-2.6 6.8 3): is a slice missing?");
  with([&](const auto& f) { f.write("again.dcm", slice(2, third)); },
       "expected one slice at each position, found again.dcm and i7.dcm at (-1.4 5.2 3)");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third + 0.3 * kNormal)); },
       "i7.dcm: ImagePositionPatient: expected");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third + glm::dvec3(0, 0, 1))); },
       "slices that are evenly spaced");
  with(
      [&](const auto& f) {
        f.write(f.name(2), slice(2, third).number(0x28, 0x10, 5).put(0x7fe0, 0x10, "OW", std::string(120, ' ')));
      },
      "i7.dcm: Columns and Rows: expected 12 x 10 pixels as in i5.dcm and 3 more slices, found 12 x 5");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).text(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")); },
       "ImageOrientationPatient: expected (0.8 0.6 0) (0 0 -1) as in i5.dcm and 3 more slices, found (1 0 0) (0 1 0)");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).text(0x28, 0x30, "DS", "0.75\\0.6")); },
       "PixelSpacing: expected");
  with([&](const auto& f) { f.write(f.name(4), slice(2, third).text(0x28, 0x30, "DS", "0\\0.5")); },
       "PixelSpacing: expected positive numbers");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).text(0x28, 0x30, "DS", "nan\\1")); },
       "PixelSpacing: expected 2 finite numbers, found \"nan\\1\"");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).remove(0x20, 0x32)); },
       "i7.dcm: ImagePositionPatient: expected");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).number(0x28, 2, 3)); }, "one sample per pixel");
  with([&](const auto& f) { f.write(f.name(2), slice(2, third).put(0x7fe0, 0x10, "OW", "short!")); },
       "i7.dcm: PixelData: expected");
  with([&](const auto& f) { writeBytes(f.folder.path() / f.name(2), slice(2, third).file().substr(0, 700)); },
       "i7.dcm: ");
}

TEST_CASE("Several DICOM series are listed, and one is picked by number or UID", "[ingest]") {
  const DicomFolder files;
  files.series(2, kNormal);
  std::filesystem::create_directory(files.folder.path() / "more");
  for (int z = 0; z < 3; ++z)
    files.write("more/" + std::to_string(z),
                slice(z, double(z) * kNormal).text(0x20, 0xe, "UI", "1.2.77").text(0x20, 0x11, "IS", "2"));
  CHECK_THROWS_AS(files.open(), SeveralSeries);
  CHECK_THROWS_WITH(files.open(), Contains("2 series, pick one by number or UID") &&
                                      Contains("1: CT \"thorax\", 3 files, 1.2.77; 2: CT \"thorax\", 2 files, 1.2.3"));
  CHECK(openDicom(files.folder.path(), {.series = "1"})->info().dims.z == 3);
  CHECK(openDicom(files.folder.path(), {.series = "1.2.3"})->info().dims.z == 2);
  CHECK_THROWS_AS(openDicom(files.folder.path(), {.series = "3"}), InvalidArgument);
  CHECK(openVolume(files.folder.path() / files.name(1))->info().dims.z == 1);  // a file is a slice
}

TEST_CASE("DICOM voxels are the same in every transfer syntax", "[ingest]") {
  using gdcm::TransferSyntax;
  const DicomFolder files;
  files.write("v.dcm", slice(0, glm::dvec3(0)));
  const auto path = files.folder.path() / "v.dcm";
  checkVoxels(*openVolume(path), 1);
  for (const auto syntax : {TransferSyntax::RLELossless, TransferSyntax::JPEGLosslessProcess14_1,
                            TransferSyntax::JPEGLSLossless, TransferSyntax::JPEG2000Lossless}) {
    CAPTURE(TransferSyntax::GetTSString(syntax));
    gdcm::ImageReader reader;
    reader.SetFileName(path.c_str());
    REQUIRE(reader.Read());
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(syntax);
    change.SetInput(reader.GetImage());
    REQUIRE(change.Change());
    gdcm::ImageWriter writer;
    const auto packed = files.folder.path() / "packed.dcm";
    writer.SetFileName(packed.c_str());
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    REQUIRE(writer.Write());
    checkVoxels(*openVolume(packed), 1);
    const std::string bytes = readBytes(packed);
    writeBytes(packed, bytes.substr(0, bytes.size() - 60));
    CHECK_THROWS_AS(readVolume(*openVolume(packed)), IoError);
  }
  files.write("v.dcm", slice(0, glm::dvec3(0), /*big=*/true));
  checkVoxels(*openVolume(path), 1);
}

// GDCM fills such a picture up with grey.
TEST_CASE("A JPEG whose codes end early or are left over is refused", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.dcm";
  const std::string good = readBytes(UMBRICK_FUZZ_CORPUS "/dicom/seed-jpeg");
  writeBytes(path, good);
  CHECK(readVolume(*openVolume(path)).size() == 64);
  const std::size_t scan = good.find("\xff\xda") + 10, end = good.rfind("\xff\xd9");
  REQUIRE(scan < end);
  for (std::size_t at = scan; at + 1 < end; ++at) {
    CAPTURE(at);
    std::string cut = good;
    cut.replace(at, 2, "\xff\xd9");
    writeBytes(path, cut);
    CHECK_THROWS_WITH(readVolume(*openVolume(path)),
                      Contains("v.dcm: PixelData: frame 1: expected a whole JPEG, found"));
  }
  std::string marker = good;
  marker.replace(scan + 1, 2, "\xff\xd3");
  writeBytes(path, marker);
  CHECK_THROWS_WITH(readVolume(*openVolume(path)), Contains("expected a whole JPEG"));
}

TEST_CASE("DICOM bits above the stored ones are masked off", "[ingest]") {
  const DicomFolder files;
  Elements flagged = slice(0, glm::dvec3(0)).number(0x28, 0x101, 12).number(0x28, 0x102, 11).number(0x28, 0x103, 0);
  std::vector<std::uint16_t> values(kColumns * kRows, 0x8123);
  files.write("v.dcm", flagged.put(0x7fe0, 0x10, "OW", bytesOf(values)));
  CHECK(readVolume(*files.open())[5] == -1000 + 2 * 0x123);
}

TEST_CASE("Frames of an enhanced DICOM file have planes and rescales of their own", "[ingest]") {
  const DicomFolder files;
  Elements file = slice(0, glm::dvec3(0));
  for (const unsigned element : {0x32u, 0x37u}) file.remove(0x20, element);
  for (const unsigned element : {0x30u, 0x1052u, 0x1053u}) file.remove(0x28, element);
  file.text(0x28, 8, "IS", "3");
  std::string all;
  std::vector<Elements> perFrame;
  for (const int z : {2, 0, 1}) {  // not in order
    all += pixels(z);
    const glm::dvec3 at = glm::dvec3(1, 2, 3) + 1.5 * z * kNormal;
    perFrame.push_back(
        Elements().sequence(0x20, 0x9113, {Elements().text(0x20, 0x32, "DS", numbers({at.x, at.y, at.z}))}));
    perFrame.back().sequence(0x28, 0x9145,
                             {Elements().text(0x28, 0x1052, "DS", "-1000").text(0x28, 0x1053, "DS", "2")});
  }
  file.put(0x7fe0, 0x10, "OW", all).sequence(0x5200, 0x9230, perFrame);
  file.sequence(0x5200, 0x9229,
                {Elements()
                     .sequence(0x20, 0x9116, {Elements().text(0x20, 0x37, "DS", numbers(kOrientation))})
                     .sequence(0x28, 0x9110, {Elements().text(0x28, 0x30, "DS", "0.75\\0.5")})});
  files.write("v.dcm", file);
  const auto source = files.open();
  checkMatrix(source->info().indexToWorld, 1.5 * kNormal);
  checkVoxels(*source, 3);
  // Frames that only say how far apart they are.
  Elements plain =
      slice(0, glm::dvec3(1, 2, 3)).text(0x28, 8, "IS", "3").put(0x7fe0, 0x10, "OW", pixels(0) + pixels(1) + pixels(2));
  files.write("v.dcm", plain);
  files.refused("SpacingBetweenSlices: expected the distance of the frames");
  files.write("v.dcm", plain.text(0x18, 0x88, "DS", "1.5"));
  checkMatrix(files.open()->info().indexToWorld, 1.5 * kNormal);
  checkVoxels(*files.open(), 3);
  files.write("v.dcm", plain.text(0x28, 8, "IS", "300"));
  files.refused("PixelData: expected 12 x 10 x 300 i16 = 72000 bytes, found 720");
}

TEST_CASE("DICOM files with flipped bytes end in a volume or an error", "[ingest]") {
  const DicomFolder files;
  const std::string good = slice(0, glm::dvec3(0)).file();
  std::mt19937 random(17);
  for (int trial = 0; trial < 500; ++trial) {
    std::string bytes = good;
    for (int i = 0; i < 1 + trial % 3; ++i) bytes[132 + random() % (bytes.size() - 132)] = static_cast<char>(random());
    if (trial % 5 == 0) bytes.resize(140 + random() % (bytes.size() - 140));
    writeBytes(files.folder.path() / "v.dcm", bytes);
    try {
      readVolume(*openVolume(files.folder.path() / "v.dcm"));
    } catch (const Error&) {
    }
  }
}
