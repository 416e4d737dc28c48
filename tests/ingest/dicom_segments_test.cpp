// DICOM segmentations: frames of one segment each, binary or fractional.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "ingest/dicom_segmentation.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/segment_source.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;

TEST_CASE("Frames of a segmentation lie in their slices, which may be missing or shared", "[ingest]") {
  const DicomFolder files;
  // Segments in two places each, in no order, with a slice that only one has and one that none has.
  const std::vector<Shown> frames{{2, 7.5}, {1, 0}, {1, 2.5}, {2, 0}};
  for (const bool fractional : {false, true}) {
    files.write("s.dcm", segmentation(frames, fractional));
    const auto source = openDicomSegments(files.folder.path() / "s.dcm");
    REQUIRE(source);
    CHECK(source->info().dims == glm::i64vec3(kColumns, kRows, 4));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(source->info().indexToWorld[0][axis] == Approx(0.5 * kOrientation[std::size_t(axis)]).margin(1e-12));
      CHECK(source->info().indexToWorld[2][axis] == Approx(2.5 * kNormal[axis]).margin(1e-12));
      CHECK(source->info().indexToWorld[3][axis] == Approx(1 + axis).margin(1e-12));
    }
    REQUIRE(source->info().labels.size() == 2);
    CHECK(source->info().labels[0].name == "liver");
    CHECK(source->info().labels[1].value == 2);
    REQUIRE(source->frames().size() == 4);
    std::vector<float> shares(kColumns * kRows);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      CHECK(source->frames()[i].label == std::size_t(frames[i].segment - 1));
      CHECK(source->frames()[i].slice == std::lround(frames[i].place / 2.5));
      source->read(i, shares);
      std::size_t wrong = 0;
      for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x)
          wrong += shares[std::size_t(y * kColumns + x)] != (isSet(i, x, y) ? (fractional ? 0.25f : 1.0f) : 0.0f);
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("The recommended colour of a segment is turned from CIE Lab to sRGB", "[ingest]") {
  const DicomFolder files;
  const auto colourOf = [&](double l, double a, double b) {
    const auto word = [](double share) { return static_cast<std::uint16_t>(std::lround(share * 65535)); };
    Elements file = segmentation({{1, 0}});
    file.sequence(0x62, 2,
                  {Elements()
                       .number(0x62, 4, 1)
                       .put(0x62, 0xd, "US", us({word(l / 100), word((a + 128) / 255), word((b + 128) / 255)}))});
    files.write("s.dcm", file);
    return *openDicomSegments(files.folder.path() / "s.dcm")->info().labels.at(0).colour;
  };
  const auto near = [](const glm::dvec3& found, const glm::dvec3& expected) {
    for (int k = 0; k < 3; ++k) CHECK(found[k] == Approx(expected[k]).margin(0.01));  // two decimals of the Lab values
  };
  // White, black and the primaries of sRGB: their values under D50 as Lindbloom's calculator gives them.
  near(colourOf(100, 0, 0), {1, 1, 1});
  near(colourOf(0, 0, 0), {0, 0, 0});
  near(colourOf(54.29, 80.81, 69.89), {1, 0, 0});
  near(colourOf(87.82, -79.29, 80.99), {0, 1, 0});
  near(colourOf(29.57, 68.30, -112.03), {0, 0, 1});
}

TEST_CASE("Segmentations that lie on no grid, or name no segment, are refused", "[ingest]") {
  const DicomFolder files;
  const auto refused = [&](const Elements& file, const std::string& what) {
    files.write("s.dcm", file);
    CHECK_THROWS_AS(openDicomSegments(files.folder.path()), IoError);
    CHECK_THROWS_WITH(openDicomSegments(files.folder.path()), Contains(what));
  };
  refused(segmentation({{1, 0}, {1, 2.5}, {1, 3.6}}), "expected frames on an even grid along their normal");
  refused(segmentation({{1, 0}, {3, 2.5}}),
          "frame 2: expected a ReferencedSegmentNumber of the SegmentSequence, found 3");
  refused(segmentation({{1, 0}, {1, 2.5}}).remove(0x5200, 0x9229), "frame 1: expected ImagePositionPatient");
  files.write("s.dcm", slice(0, glm::dvec3(0)));
  CHECK_FALSE(openDicomSegments(files.folder.path() / "s.dcm"));
}

TEST_CASE("Frames of segments that are no volume together are told to be a segmentation", "[ingest]") {
  const DicomFolder files;
  const auto refused = [&](const std::vector<Shown>& frames, const std::string& what) {
    files.write("s.dcm", segmentation(frames));
    CHECK_THROWS_AS(openVolume(files.folder.path() / "s.dcm"), SegmentsFound);
    CHECK_THROWS_WITH(openVolume(files.folder.path() / "s.dcm"),
                      Contains("a DICOM segmentation of 2 segments, whose frames are no volume: " + what));
  };
  refused({{1, 0}, {2, 0}}, "expected one segment, found frames of 1 and 2");
  refused({{1, 0}, {2, 2.5}}, "expected one segment, found frames of 1 and 2");
  refused({{1, 0}, {1, 2.5}, {1, 7.5}}, "");
}

TEST_CASE("Pixels of one bit are a volume of 0 and 1", "[ingest]") {
  const DicomFolder files;
  files.write("s.dcm", segmentation({{1, 0}, {1, 2.5}, {1, 5}}));
  const std::vector<float> values = readVolume(*openVolume(files.folder.path()));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t pixel = i % (kColumns * kRows);
    wrong += values[i] != float(isSet(i / (kColumns * kRows), int(pixel % kColumns), int(pixel / kColumns)));
  }
  CHECK(values.size() == 3 * kColumns * kRows);
  CHECK(wrong == 0);
}
