// The time that files of volumes state is kept, as it stands there.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "ingest/dicom_files.h"
#include "ingest/small_volume.h"
#include "ingest/write_hdf5.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/ingest/dicom_volume.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;

namespace {

// What the metadata of a volume say of time: "frame 2, time 0.5, time_step 0.25, time_unit s".
std::string timeOf(const VolumeInfo& info) {
  std::string text;
  for (const char* key : {"frame", "time", "time_step", "time_unit", "cycle"})
    if (const auto found = info.metadata.find(key); found != info.metadata.end())
      text += (text.empty() ? "" : ", ") + std::string(key) + ' ' + found->second;
  return text;
}

std::string timeOf(const std::filesystem::path& path, std::optional<std::int64_t> frame = {}) {
  OpenOptions options;
  options.parts.frame = frame;
  return timeOf(openVolume(path, options)->info());
}

// A NIfTI header of 1 x 1 x 1 voxels of 8 bits at three times, by the byte offsets of nifti1.h and nifti2.h.
std::string niftiOfThree(int version, char units, double step, double first) {
  std::string bytes(version == 1 ? 352 : 544, '\0');
  const auto put = [&](std::size_t at, const std::string& value) { bytes.replace(at, value.size(), value); };
  if (version == 1) {
    put(0, bytesOf<std::int32_t>({348}));
    put(40, bytesOf<std::int16_t>({4, 1, 1, 1, 3, 1, 1, 1}));
    put(70, bytesOf<std::int16_t>({2, 8}));
    put(76, bytesOf<float>({1, 1, 1, 1, static_cast<float>(step)}));
    put(108, bytesOf<float>({352}));
    put(123, std::string(1, units));
    put(136, bytesOf<float>({static_cast<float>(first)}));
    put(344, std::string("n+1\0", 4));
  } else {
    put(0, bytesOf<std::int32_t>({540}));
    put(4, std::string("n+2\0\r\n\x1a\n", 8));
    put(12, bytesOf<std::int16_t>({2, 8}));
    put(16, bytesOf<std::int64_t>({4, 1, 1, 1, 3, 1, 1, 1}));
    put(104, bytesOf<double>({1, 1, 1, 1, step}));
    put(168, bytesOf<std::int64_t>({544}));
    put(216, bytesOf<double>({first}));
    put(500, bytesOf<std::int32_t>({units}));
  }
  return bytes + "abc";
}

}  // namespace

TEST_CASE("A volume of a NIfTI file is at toffset and so many times pixdim 4, in the unit of time", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nii";
  for (const int version : {1, 2}) {
    CAPTURE(version);
    writeBytes(path, niftiOfThree(version, 2 | 8, 0.75, 0));
    CHECK(timeOf(path, 0) == "frame 0, time 0, time_step 0.75, time_unit s");
    CHECK(timeOf(path, 2) == "frame 2, time 1.5, time_step 0.75, time_unit s");
    writeBytes(path, niftiOfThree(version, 2 | 16, 40, 5));
    CHECK(timeOf(path, 1) == "frame 1, time 45, time_step 40, time_unit ms");
    writeBytes(path, niftiOfThree(version, 2 | 24, 40, 5));
    CHECK(timeOf(path, 1) == "frame 1, time 45, time_step 40, time_unit us");
    // Hertz are no time, and without a unit pixdim is 1 by default.
    for (const char units : {char(2), char(2 | 32)}) {
      writeBytes(path, niftiOfThree(version, units, 1, 0));
      CHECK(timeOf(path, 1) == "frame 1");
    }
  }
}

TEST_CASE("An axis of time of NRRD states step, begin and unit, as far as they are known", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nrrd";
  const std::string start = "NRRD0004\ntype: uint8\ndimension: 4\nencoding: raw\nsizes: 1 1 1 3\n";
  const std::string kinds = "kinds: domain domain domain time\n";
  writeBytes(path,
             start + kinds + "spacings: 1 1 1 0.04\naxis mins: 0 0 0 2\nunits: \"mm\" \"mm\" \"mm\" \"s\"\n\nabc");
  CHECK(timeOf(path, 2) == "frame 2, time 2.08, time_step 0.04, time_unit s");
  writeBytes(path, start + kinds + "\nabc");
  CHECK(timeOf(path, 2) == "frame 2");
  // Beside directions of space.
  writeBytes(path, start + "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1) none\n" + kinds +
                       "spacings: nan nan nan 20\nunits: \"\" \"\" \"\" \"ms\"\n\nabc");
  CHECK(timeOf(path, 1) == "frame 1, time 20, time_step 20, time_unit ms");
}

TEST_CASE("TimeValue of a VTI file is its time, however it is stored", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.vti";
  const auto file = [](const std::string& field, const std::string& appended = {}) {
    return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">"
           "<ImageData WholeExtent=\"0 1 0 0 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\">" +
           field +
           "<Piece Extent=\"0 1 0 0 0 0\"><PointData Scalars=\"a\"><DataArray type=\"UInt8\" Name=\"a\" "
           "format=\"ascii\">3 4</DataArray></PointData></Piece></ImageData>" +
           appended + "</VTKFile>";
  };
  const auto field = [](const std::string& format, const std::string& value, const std::string& type = "Float64") {
    return "<FieldData><DataArray type=\"Float64\" Name=\"Other\" NumberOfTuples=\"1\" format=\"ascii\">7</DataArray>"
           "<DataArray type=\"" +
           type + "\" Name=\"TimeValue\" NumberOfTuples=\"1\" " + format + ">" + value + "</DataArray></FieldData>";
  };
  const auto is = [&](const std::string& content, const std::string& time) {
    writeBytes(path, content);
    CHECK(timeOf(path) == time);
    CHECK(readVolume(*openVolume(path)) == std::vector<float>{3, 4});
  };
  is(file(""), "");
  is(file(field("format=\"ascii\"", " 0.125\n")), "time 0.125");
  is(file(field("format=\"ascii\"", "0.5", "Float32")), "time 0.5");
  // The length of 8 bytes and 1.5 in base64.
  is(file(field("format=\"binary\"", "CAAAAAAAAAAAAPg/")), "time 1.5");
  std::string big = file(field("format=\"binary\"", "AAAACD/4AAAAAAAA"));  // the same, the highest byte first
  big.replace(big.find("Little"), 6, "Big");
  is(big, "time 1.5");
  is(file(field("format=\"appended\" offset=\"0\"", ""), "<AppendedData encoding=\"raw\">_" +
                                                             bytesOf<std::uint32_t>({8}) + bytesOf<double>({-2.25}) +
                                                             "</AppendedData>"),
     "time -2.25");
  // A time that cannot be read is none, and the volume is good.
  is(file(field("format=\"ascii\"", "soon")), "");
  is(file(field("format=\"appended\" offset=\"0\"", "")), "");
}

TEST_CASE("TIME, TimeValue and CYCLE before the voxels of a legacy VTK file are its time and step", "[ingest]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.vtk";
  const auto is = [&](const std::string& kind, const std::string& field, const std::string& time) {
    writeBytes(path, "# vtk DataFile Version 3.0\n\n" + kind + "\nDATASET STRUCTURED_POINTS\n" + field +
                         "DIMENSIONS 2 1 1\nSPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 2\nSCALARS a unsigned_char 1\n"
                         "LOOKUP_TABLE default\n" +
                         (kind == "ASCII" ? "3 4\n" : "\3\4"));
    CHECK(timeOf(path) == time);
    CHECK(readVolume(*openVolume(path)) == std::vector<float>{3, 4});
  };
  is("ASCII", "FIELD FieldData 2\nTIME 1 1 double\n0.75\nCYCLE 1 1 int\n1200\n", "time 0.75, cycle 1200");
  is("ASCII", "FIELD FieldData 2\nOther 2 1 float\n1 2\nTimeValue 1 1 float\n2.5\n", "time 2.5");
  is("BINARY",
     "FIELD FieldData 2\nTIME 1 1 double\n" + bytesOf<double>({0.75}, true) + "\nCYCLE 1 1 int\n" +
         bytesOf<std::int32_t>({1200}, true) + "\n",
     "time 0.75, cycle 1200");
  is("BINARY", "FIELD FieldData 1\nTimeValue 1 1 float\n" + bytesOf<float>({2.5f}, true) + "\n", "time 2.5");
  is("ASCII", "FIELD FieldData 1\nTIME 1 1 double\nnan\n", "");
}

TEST_CASE("The scale of an axis of time of netCDF says when each volume is", "[ingest][hdf5]") {
  const Hdf5File file;
  // Three volumes, whose axis of time has a scale.
  const auto add = [&](const std::string& name, hsize_t frames, const std::vector<double>& times,
                       const std::string& unit) {
    const std::string set = "/" + name, scale = "/" + name + "_t";
    file.add(set.c_str(), {frames, 2, 2, 5}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(frames * 20, 1));
    file.add(scale.c_str(), {times.size()}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, times);
    describe(file, scale.c_str(), "units", unit.c_str());
    describe(file, scale.c_str(), "axis", "T");
    const hid_t opened = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t data = H5Dopen2(opened, set.c_str(), H5P_DEFAULT);
    hobj_ref_t reference;
    H5Rcreate(&reference, opened, scale.c_str(), H5R_OBJECT, -1);
    std::vector<hvl_t> lists{{1, &reference}, {0, nullptr}, {0, nullptr}, {0, nullptr}};
    const hsize_t count = 4;
    const hid_t type = H5Tvlen_create(H5T_STD_REF_OBJ), space = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute = H5Acreate2(data, "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, lists.data());
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(data);
    H5Fclose(opened);
  };
  add("even", 3, {6, 12, 18}, "hours since 2000-01-01");
  CHECK(timeOf(file.path.string() + ":/even", 2) == "frame 2, time 18, time_step 6, time_unit hours since 2000-01-01");
  add("uneven", 3, {6, 12, 19}, "s");
  CHECK(timeOf(file.path.string() + ":/uneven", 1) == "frame 1, time 12, time_unit s");
  add("single", 1, {4.5}, "s");
  CHECK(timeOf(file.path.string() + ":/single") == "time 4.5, time_unit s");
  add("short", 3, {6, 12}, "s");
  CHECK(timeOf(file.path.string() + ":/short", 1) == "frame 1");
}

TEST_CASE("What all slices of a DICOM series say of time is kept, and what they say differently is not", "[ingest]") {
  using namespace umbrick::dicom_files;
  const DicomFolder files;
  for (int z = 0; z < 3; ++z) {
    Elements file = slice(z, glm::dvec3(1, 2, 3) + 2.0 * z * kNormal).text(0x20, 0x100, "IS", "4");
    file.text(0x18, 0x1060, "DS", "312.5").text(0x8, 0x22, "DA", "20240229");
    files.write(std::to_string(z) + ".dcm", file.text(0x8, 0x32, "TM", "1011" + std::to_string(10 + z)));
  }
  const VolumeInfo info = openDicom(files.folder.path())->info();
  CHECK(timeOf(info) == "frame 4, time 312.5, time_unit ms");
  CHECK(info.metadata.at("acquisition_date") == "20240229");
  CHECK_FALSE(info.metadata.contains("acquisition_time"));
}
