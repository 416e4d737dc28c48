// Which slices of a DICOM folder make the volume, and how far apart they are.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <filesystem>

#include "ingest/dicom_files.h"
#include "umbrick/ingest/dicom_volume.h"

using namespace umbrick;
using namespace umbrick::dicom_files;
using Catch::Contains;

namespace {

glm::dvec3 onAxis(double z) { return glm::dvec3(1, 2, 3) + 2.0 * z * kNormal; }

// Slices along z, whose first voxel has the value of their position.
void writeAxial(const DicomFolder& files, const std::vector<std::string>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Elements file = slice(0, glm::dvec3(0)).text(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
    file.text(0x20, 0x32, "DS", "0\\0\\" + positions[i]).text(0x28, 0x1053, "DS", "0");
    files.write(std::to_string(i) + ".dcm", file.text(0x28, 0x1052, "DS", positions[i]));
  }
}

std::vector<float> firstVoxels(VoxelSource& source) {
  const std::vector<float> all = readVolume(source);
  std::vector<float> out;
  for (std::size_t at = 0; at < all.size(); at += kColumns * kRows) out.push_back(all[at]);
  return out;
}

}  // namespace

TEST_CASE("Phases of one DICOM series are listed by the tags in which they differ, and one is picked", "[ingest]") {
  const DicomFolder files;
  for (int phase = 1; phase <= 2; ++phase)
    for (int z = 0; z < 3; ++z) {
      Elements file = slice(z + 3 * (phase - 1), onAxis(z)).text(0x20, 0x12, "IS", std::to_string(phase));
      file.text(0x18, 0x81, "DS", phase == 1 ? "4.60" : "9.2").text(0x20, 0x13, "IS", std::to_string(10 * phase + z));
      files.write(std::to_string(phase) + std::to_string(z) + ".dcm", file);
    }
  CHECK_THROWS_AS(files.open(), SeveralPhases);
  files.refused("found 10.dcm and 20.dcm at (1 2 3); they differ in AcquisitionNumber (1, 2), EchoTime (4.60, 9.2)");
  const auto value = [&](const std::vector<std::string>& where) {
    const auto source = openDicom(files.folder.path(), {.where = where});
    CHECK(source->info().dims.z == 3);
    return readVolume(*source)[0];
  };
  const float first = -1000, second = float(-1000 + 2 * stored(0, 0, 3));
  CHECK(value({"AcquisitionNumber=1"}) == first);
  CHECK(value({"acquisitionnumber = 2"}) == second);
  CHECK(value({"0020,0012=2"}) == second);
  CHECK(value({"(0018,0081)=4.6"}) == first);  // as a number
  CHECK(value({"EchoTime=9.2", "AcquisitionNumber=2"}) == second);
  const auto refused = [&](const std::string& where, const std::string& what) {
    CHECK_THROWS_AS(openDicom(files.folder.path(), {.where = {where}}), InvalidArgument);
    CHECK_THROWS_WITH(openDicom(files.folder.path(), {.where = {where}}), Contains(what));
  };
  refused("AcquisitionNumber=3", "no slice has AcquisitionNumber 3: there are 1 (3 slices), 2 (3 slices)");
  refused("TriggerTime=3", "no slice has TriggerTime 3: there is none that states it");
  refused("NoSuchTag=3", "where: expected Tag=value, the tag a keyword of DICOM or gggg,eeee, found \"NoSuchTag=3\"");
}

TEST_CASE("The few DICOM slices that are unlike the others are named, and a series is read without them", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 4; ++z) files.write("s" + std::to_string(z) + ".dcm", slice(z, onAxis(z)));
  // It comes first by its name.
  files.write("a.dcm",
              slice(9, onAxis(0)).text(0x20, 0x37, "DS", "0\\1\\0\\0\\0\\-1").text(8, 8, "CS", "ORIGINAL\\LOCALIZER"));
  CHECK_THROWS_AS(files.open(), OddSlices);
  files.refused(
      "a.dcm: ImageOrientationPatient: expected (0.8 0.6 0) (0 0 -1) as in s0.dcm and 3 more slices, found (0 1 0)");
  const auto picked = openDicom(files.folder.path(), {.series = "1.2.3"});
  checkVoxels(*picked, 4);
  CHECK(noted(*picked, "a.dcm is left out: ImageOrientationPatient"));
  for (int z = 0; z < 4; ++z)
    files.write("s" + std::to_string(z) + ".dcm", slice(z, onAxis(z)).text(8, 8, "CS", "ORIGINAL\\AXIAL"));
  checkVoxels(*openDicom(files.folder.path(), {.where = {"ImageType=AXIAL"}}), 4);
}

TEST_CASE("A damaged DICOM file in a folder is named, and a series is read without it", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 4; ++z) files.write("s" + std::to_string(z) + ".dcm", slice(z, onAxis(z)));
  const auto damage = [&](const char* uid, std::size_t bytes) {
    const std::string whole = slice(4, onAxis(4)).text(0x20, 0xe, "UI", uid).file();
    writeBytes(files.folder.path() / "z.dcm", whole.substr(0, bytes));
    CHECK_THROWS_AS(files.open(), OddSlices);
    files.refused("z.dcm: expected ");
    auto picked = openDicom(files.folder.path(), {.series = "1"});
    checkVoxels(*picked, 4);
    return picked;
  };
  damage("1.2.77", 700);                                                // another series
  CHECK(noted(*damage("1.2.3", 700), "z.dcm is left out: "));           // the same
  CHECK(noted(*damage("1.2.3", 250), "left out, of whatever series"));  // nobody knows
}

TEST_CASE("Slices that state no place are spaced as they are told to be", "[ingest]") {
  const DicomFolder files;
  for (int z = 0; z < 3; ++z)
    files.write(files.name(z), slice(z, onAxis(z))
                                   .remove(0x20, 0x32)
                                   .remove(0x20, 0x37)
                                   .remove(0x28, 0x30)
                                   .text(0x20, 0x13, "IS", std::to_string(z + 1)));
  CHECK_THROWS_AS(files.open(), UnplacedSlices);
  files.refused("ImagePositionPatient: expected the position of the slice, found nothing");
  const auto source =
      openVolume(files.folder.path(), {.spacing = glm::dvec3(0.5, 0.75, 4), .origin = glm::dvec3(7, 8, 9)});
  checkVoxels(*source, 3);
  const glm::dmat4 expected(0.5, 0, 0, 0, 0, 0.75, 0, 0, 0, 0, 4, 0, 7, 8, 9, 1);
  CHECK(source->info().indexToWorld == expected);
  CHECK(noted(*source, "follow each other by InstanceNumber"));
  files.series(3, 2.0 * kNormal);
  CHECK_THROWS_AS(openVolume(files.folder.path(), {.spacing = glm::dvec3(1)}), InvalidArgument);
  // Only the pixels' distance is missing.
  for (int z = 0; z < 3; ++z) files.write(files.name(z), slice(z, onAxis(z)).remove(0x28, 0x30));
  checkMatrix(openVolume(files.folder.path(), {.spacing = glm::dvec3(0.5, 0.75, 1)})->info().indexToWorld,
              2.0 * kNormal);
}

// 0.625 mm apart and written to a tenth: each is off by up to 0.05 mm, which is 8 % of a step.
TEST_CASE("Positions may be off even steps by the digits that are not written", "[ingest]") {
  const DicomFolder files;
  writeAxial(files, {"0", "0.6", "1.3", "1.9", "2.5", "3.1", "3.8", "4.4"});
  const auto source = files.open();
  CHECK(source->info().indexToWorld[2][2] == Approx(4.4 / 7));
  CHECK(noted(*source, "off even steps"));
  // A slice that is missing is seen all the same, and so is one that is as far off as digits do not explain.
  std::filesystem::remove(files.folder.path() / "3.dcm");
  files.refused("is a slice missing?");
  const DicomFolder exact;
  writeAxial(exact, {"0.000", "0.625", "1.300", "1.875", "2.501"});
  exact.refused("1.3");
}

TEST_CASE("Uneven slices are interpolated along the normal where that is asked for", "[ingest]") {
  const DicomFolder files;
  writeAxial(files, {"0", "2", "4", "8", "10"});  // one is missing
  CHECK_THROWS_AS(files.open(), UnevenSlices);
  const auto missing = openDicom(files.folder.path(), {.evenSlices = true});
  CHECK(missing->info().indexToWorld[2][2] == 2);
  CHECK(firstVoxels(*missing) == std::vector<float>{0, 2, 4, 6, 8, 10});
  CHECK(noted(*missing, "1 of 6, 2.000000 mm apart, are interpolated between neighbours up to 4.000000 mm apart"));
  const DicomFolder uneven;
  writeAxial(uneven, {"0", "1", "2", "5", "8", "11", "12"});
  const auto even = openDicom(uneven.folder.path(), {.evenSlices = true});
  // As fine as the closest slices. The field is linear along the normal, so that interpolation is exact.
  const std::vector<float> values = firstVoxels(*even);
  REQUIRE(values.size() == 13);
  for (std::size_t z = 0; z < values.size(); ++z) CHECK(values[z] == Approx(float(z)));
  const auto plain = [&] {
    const DicomFolder regular;
    writeAxial(regular, {"0", "1", "2"});
    return openDicom(regular.folder.path(), {.evenSlices = true});
  }();
  CHECK(plain->info().notes.empty());
}
