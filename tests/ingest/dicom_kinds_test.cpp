// DICOM files as they come from scanners, archives and copies: what is read of each kind, and what is said of it.
// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <catch2/catch.hpp>

#include "ingest/dicom_files.h"
#include "umbrick/ingest/dicom_volume.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;

namespace {

// Behind the file meta information, deflate without a head (PS3.5 A.5).
std::string deflated(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string allPixels(int count) {
  std::string out;
  for (int z = 0; z < count; ++z) out += pixels(z);
  return out;
}

// A file of nuclear medicine, whose slices are frames.
Elements tomography(int slices, const char* step) {
  Elements file = slice(0, glm::dvec3(1, 2, 3));
  file.text(8, 0x60, "CS", "NM").text(0x28, 8, "IS", std::to_string(slices)).text(0x18, 0x88, "DS", step);
  return file.put(0x7fe0, 0x10, "OW", allPixels(slices));
}

glm::dvec3 at(int z) { return glm::dvec3(1, 2, 3) + 2.0 * z * kNormal; }

}  // namespace

// PS3.3 C.8.4.15: the sign of SpacingBetweenSlices says on which side of the first frame the others lie.
TEST_CASE("Frames of nuclear medicine that lie against the normal are put there", "[ingest]") {
  const DicomFolder files;
  files.write("v.dcm", tomography(4, "-3"));
  const auto source = files.open();
  // The frame that is lowest along the normal comes first.
  const glm::dmat4 map = source->info().indexToWorld;
  const glm::dvec3 last = glm::dvec3(1, 2, 3) - 9.0 * kNormal;
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(map[3][axis] == Approx(last[axis]).margin(1e-12));
    CHECK(map[2][axis] == Approx(3 * kNormal[axis]).margin(1e-12));
  }
  const std::vector<float> values = readVolume(*source);
  const std::size_t voxels = kColumns * kRows;
  for (std::size_t z = 0; z < 4; ++z) CHECK(values[z * voxels] == float(-1000 + 2 * stored(0, 0, 3 - int(z))));
  files.write("v.dcm", tomography(4, "3"));
  checkMatrix(files.open()->info().indexToWorld, 3.0 * kNormal);
}

TEST_CASE("The plane of nuclear medicine may be stated by its detector", "[ingest]") {
  const DicomFolder files;
  Elements file = tomography(3, "1.5");
  const Elements plane = Elements().text(0x20, 0x32, "DS", "1\\2\\3").text(0x20, 0x37, "DS", numbers(kOrientation));
  files.write("v.dcm", file.remove(0x20, 0x32).remove(0x20, 0x37).sequence(0x54, 0x22, {plane}));
  const auto source = files.open();
  checkMatrix(source->info().indexToWorld, 1.5 * kNormal);
  checkVoxels(*source, 3);
}

TEST_CASE("Gated frames are several volumes, of which a phase is picked", "[ingest]") {
  const DicomFolder files;
  Elements file = tomography(4, "2");
  file.put(0x28, 9, "AT", bytesOf<std::uint16_t>({0x54, 0x70, 0x54, 0x80}));
  file.put(0x54, 0x70, "US", bytesOf<std::uint16_t>({1, 1, 2, 2}));
  file.put(0x54, 0x80, "US", bytesOf<std::uint16_t>({1, 2, 1, 2}));
  files.write("v.dcm", file);
  CHECK_THROWS_AS(files.open(), SeveralPhases);
  CHECK_THROWS_WITH(files.open(), Contains("they differ in TimeSlotVector (1, 2)"));
  const auto second = openDicom(files.folder.path(), {.where = {"TimeSlotVector=2"}});
  checkMatrix(second->info().indexToWorld, 2.0 * kNormal);
  CHECK(readVolume(*second)[0] == float(-1000 + 2 * stored(0, 0, 2)));
  files.write("v.dcm", file.put(0x28, 9, "AT", bytesOf<std::uint16_t>({0x54, 0x50})).remove(0x54, 0x80));
  files.refused("FrameIncrementPointer: expected SliceVector, frames that are slices, found \"RotationVector\"");
}

TEST_CASE("A Siemens mosaic is unfolded, or refused by that name", "[ingest]") {
  const DicomFolder files;
  constexpr int kSlices = 5;  // of 3 x 3 tiles
  std::vector<std::int16_t> values(9 * kColumns * kRows, 0);
  for (int z = 0; z < kSlices; ++z)
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x)
        values[std::size_t(((z / 3) * kRows + y) * 3 * kColumns + z % 3 * kColumns + x)] = stored(x, y, z);
  // The position is that of a picture of the whole mosaic around the centre of the first slice.
  const glm::dvec3 corner =
      glm::dvec3(1, 2, 3) - 12.0 * 0.5 * glm::dvec3(0.8, 0.6, 0) - 10.0 * 0.75 * glm::dvec3(0, 0, -1);
  Elements file = slice(0, corner).number(0x28, 0x10, 3 * kRows).number(0x28, 0x11, 3 * kColumns);
  file.text(8, 8, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC").text(0x18, 0x88, "DS", "2.5");
  file.put(0x7fe0, 0x10, "OW", bytesOf(values));
  files.write("v.dcm", file);
  files.refused("v.dcm: ImageType: expected one slice, or a mosaic that says of how many slices");
  files.write("v.dcm", file.text(0x19, 0x10, "LO", "SIEMENS MR HEADER").number(0x19, 0x100a, kSlices));
  const auto source = files.open();
  checkMatrix(source->info().indexToWorld, 2.5 * kNormal);
  checkVoxels(*source, kSlices);
  CHECK(noted(*source, "a Siemens mosaic, unfolded (v.dcm: 5 slices of 12 x 10)"));
  files.write("v.dcm", file.number(0x19, 0x100a, 17));
  files.refused("expected a mosaic of 5 x 5 tiles for 17 slices, found \"36 x 30 pixels\"");
}

TEST_CASE("Slope and intercept of each DICOM slice are its own", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 3; ++z) {
    const std::string slope = std::to_string(z + 1), intercept = std::to_string(-10 * z);
    files.write(files.name(z), slice(z, at(z)).text(0x28, 0x1053, "DS", slope).text(0x28, 0x1052, "DS", intercept));
  }
  const auto source = files.open();
  const std::vector<float> values = readVolume(*source);
  for (int z = 0; z < 3; ++z)
    CHECK(values[std::size_t(z * kColumns * kRows + 5)] == float((z + 1) * stored(5, 0, z) - 10 * z));
  CHECK(source->info().metadata.at("rescale") == "its own for each slice");
}

// PS3.5 8.1.1 asks receivers to bear bytes behind the pixels; block-wise copies leave zeros behind the end.
TEST_CASE("Bytes behind the pixels and zeros behind the end are passed over", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 3; ++z)
    files.write(files.name(z), slice(z, at(z)).put(0x7fe0, 0x10, "OW", pixels(z) + std::string(100, 'x')));
  const auto longer = files.open();
  checkVoxels(*longer, 3);
  CHECK(noted(*longer,
              "PixelData has more bytes than the pixels, which are not read (i7.dcm: expected 240, found 340, "
              "and 2 more files)"));
  for (const std::size_t zeros : {1u, 3u, 64u, 5000u}) {
    for (int z = 0; z < 3; ++z)
      writeBytes(files.folder.path() / files.name(z), slice(z, at(z)).file() + std::string(zeros, '\0'));
    checkVoxels(*files.open(), 3);
  }
  writeBytes(files.folder.path() / files.name(0), slice(0, at(0)).file() + std::string(64, '\0') + "tail");
  CHECK_THROWS_WITH(openVolume(files.folder.path() / files.name(0)), Contains("expected a data element, found zeros"));
}

TEST_CASE("A DICOM file may lack its preamble, and other files are told apart", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 3; ++z) writeBytes(files.folder.path() / files.name(z), slice(z, at(z)).implicit());
  writeBytes(files.folder.path() / "notes.txt", "\x08 no DICOM");
  const auto implicit = files.open();
  checkVoxels(*implicit, 3);
  CHECK(noted(*implicit, "Implicit VR Little Endian"));
  const auto one = openVolume(files.folder.path() / files.name(0));
  checkVoxels(*one, 1);
  for (int z = 0; z < 3; ++z) writeBytes(files.folder.path() / files.name(z), slice(z, at(z)).bytes());
  checkVoxels(*files.open(), 3);
  for (int z = 0; z < 3; ++z) writeBytes(files.folder.path() / files.name(z), "these are no elements of a data set");
  files.refused("expected DICOM files, found 3 that are named so and have no DICOM header, such as i7.dcm");
  CHECK_THROWS_WITH(openVolume(files.folder.path() / files.name(0)), Contains("i9.dcm: expected a DICOM header"));
}

TEST_CASE("A deflated DICOM data set is unpacked", "[ingest]") {
  const DicomFolder files;
  const auto write = [&](int z, const std::string& data) {
    writeBytes(files.folder.path() / files.name(z), slice(z, at(z)).file("1.2.840.10008.1.2.1.99", data));
  };
  for (int z = 0; z < 3; ++z) write(z, deflated(slice(z, at(z)).bytes()));
  checkVoxels(*files.open(), 3);
  const std::string whole = deflated(slice(0, at(0)).bytes());
  write(0, whole.substr(0, whole.size() / 2));
  CHECK_THROWS_WITH(readVolume(*openVolume(files.folder.path() / files.name(0))), Contains("i9.dcm: "));
}
