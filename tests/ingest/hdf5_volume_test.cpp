// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/hdf5_volume.h"

#include <hdf5.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "ingest/write_hdf5.h"
#include "support/files.h"
#include "support/read_volume.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("The last axis of an HDF5 dataset is x, in every type and byte order", "[ingest]") {
  const Hdf5File file;
  const std::vector<int> values{1, 2, 3, -4, 5, 6};
  const std::vector<float> floats(values.begin(), values.end());
  for (const hid_t stored : {H5T_STD_I8LE, H5T_STD_I16BE, H5T_STD_I32LE, H5T_STD_I64BE, H5T_IEEE_F32BE, H5T_IEEE_F64LE})
    file.add(("/t/" + std::to_string(stored)).c_str(), {1, 2, 3}, stored, H5T_NATIVE_INT, values);
  for (const hid_t stored : {H5T_STD_I8LE, H5T_STD_I16BE, H5T_STD_I32LE, H5T_STD_I64BE, H5T_IEEE_F32BE, H5T_IEEE_F64LE})
    CHECK(file.read(":/t/" + std::to_string(stored)) == floats);
  file.refused("", "expected one dataset of three axes, or its name as in v.h5:/name, found /t/");
  file.add("/flat", {2, 3}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>{1, 2, 3, 4, 5, 255});
  CHECK(openVolume(file.path.string() + ":/flat")->info().dims == glm::i64vec3(3, 2, 1));
  CHECK(file.read(":/flat") == std::vector<float>{1, 2, 3, 4, 5, 255});
}

TEST_CASE("Slabs of an HDF5 dataset in chunks are the voxels that were written", "[ingest]") {
  const Hdf5File file;
  std::vector<std::uint16_t> values(7 * 6 * 5);
  std::iota(values.begin(), values.end(), std::uint16_t(1));
  file.add("/a/volume", {1, 7, 6, 5}, H5T_STD_U16BE, H5T_NATIVE_UINT16, values, {1, 3, 4, 2});
  file.add("/table", {4}, H5T_STD_U16BE, H5T_NATIVE_UINT16, values);
  const auto source = openVolume(file.path);
  CHECK(source->info().dims == glm::i64vec3(5, 6, 7));
  CHECK(source->info().type == VoxelType::u16);
  CHECK(source->info().metadata.at("source_dataset") == "/a/volume");
  CHECK(readVolume(*source) == std::vector<float>(values.begin(), values.end()));
  const auto again = openVolume(file.path.string() + ":/a/volume");
  again->skipSlices(6);
  std::vector<float> last(30);
  again->readSlab(1, last);
  CHECK(last == std::vector<float>(values.end() - 30, values.end()));
}

// The CF conventions: value = stored * scale_factor + add_offset, and what is missing is told by the stored value.
TEST_CASE("Packed values of netCDF are unpacked, and missing ones are no numbers", "[ingest]") {
  const Hdf5File file;
  file.add("/T", {1, 2, 3}, H5T_STD_I16LE, H5T_NATIVE_INT, std::vector<int>{-32767, 1, 2, 300, -9, 3000});
  describe(file, "/T", "scale_factor", H5T_IEEE_F64LE, std::vector<double>{0.01});
  describe(file, "/T", "add_offset", H5T_IEEE_F64LE, std::vector<double>{273.15});
  describe(file, "/T", "_FillValue", H5T_STD_I16LE, std::vector<int>{-32767});
  describe(file, "/T", "missing_value", H5T_STD_I16LE, std::vector<int>{-9});
  describe(file, "/T", "valid_max", H5T_STD_I16LE, std::vector<int>{2999});
  describe(file, "/T", "units", "K");
  auto source = openVolume(file.path);
  CHECK(source->info().metadata.at("rescale") == "273.14999999999998 + 0.01 * stored");
  CHECK(source->info().metadata.at("value_unit") == "K");
  REQUIRE(source->info().notes.size() == 2);
  CHECK_THAT(source->info().notes[0], Contains("dataset /T is taken"));
  CHECK_THAT(source->info().notes[1], Contains("-32767 (_FillValue), -9 (missing_value)"));
  const std::vector<float> values = readVolume(*source);
  for (const std::size_t missing : {0u, 4u, 5u}) CHECK(std::isnan(values[missing]));
  CHECK(values[1] == Approx(273.16));
  CHECK(values[3] == Approx(276.15));
  source.reset();  // so that the file can be written again
  describe(file, "/T", "valid_min", "none");
  file.refused("", "valid_min: expected a number, found \"text\"");
}

TEST_CASE("Unsigned bytes of netCDF are what they stand for, and so is their fill value", "[ingest]") {
  const Hdf5File file;
  file.add("/b", {1, 1, 3}, H5T_STD_I8LE, H5T_NATIVE_INT, std::vector<int>{-1, -2, 3});
  describe(file, "/b", "_Unsigned", "true");
  describe(file, "/b", "_FillValue", H5T_STD_I8LE, std::vector<int>{-1});
  const std::vector<float> values = file.read();
  CHECK(std::isnan(values[0]));
  CHECK(values[1] == 254);
  CHECK(values[2] == 3);
}

// ilastik and the HDF5 plugin of Fiji write the size along z, y and x.
TEST_CASE("Sizes of elements place an HDF5 dataset, whatever axes of length 1 it has", "[ingest]") {
  const Hdf5File file;
  const std::vector<int> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::vector<float> floats(values.begin(), values.end());
  for (const std::vector<hsize_t>& shape :
       std::vector<std::vector<hsize_t>>{{1, 2, 2, 3, 1}, {2, 1, 2, 1, 3}, {2, 2, 3, 1}}) {
    const std::string name = "/v" + std::to_string(shape.size()) + std::to_string(shape[0]);
    file.add(name.c_str(), shape, H5T_STD_U8LE, H5T_NATIVE_INT, values);
    describe(file, name.c_str(), "element_size_um", H5T_IEEE_F64LE, std::vector<double>{2, 0.5, 0.25});
    describe(file, name.c_str(), "offset_um", H5T_IEEE_F64LE, std::vector<double>{30, 20, 10});
    const auto source = openVolume(file.path.string() + ':' + name);
    const VolumeInfo& info = source->info();
    CHECK(info.dims == glm::i64vec3(3, 2, 2));
    CHECK(info.metadata.at("length_unit") == "mm");
    CHECK(info.metadata.at("file_length_unit") == "um");
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(info.indexToWorld[axis][axis] == Approx(std::array{0.25e-3, 0.5e-3, 2e-3}[static_cast<std::size_t>(axis)]));
      CHECK(info.indexToWorld[3][axis] == Approx(0.01 * (axis + 1)));
    }
    CHECK(readVolume(*source) == floats);
  }
}

TEST_CASE("What is no volume in an HDF5 file is refused with both values", "[ingest]") {
  const Hdf5File file;
  file.refused("", "found none");
  file.add("/line", {6}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(6));
  file.add("/many", {2, 2, 2, 2, 2, 2}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(64));
  file.add("/text", {1, 1, 1}, H5T_C_S1, H5T_C_S1, std::vector<char>{'a'});
  file.add("/opaque", {1, 1, 1}, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, std::vector<char>{});
  file.add("/huge", {1, 2000000000, 2000000000}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>{}, {1, 64, 64});
  file.add("/over", {3000000000, 3000000000, 3000000000}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>{}, {1, 8, 8});
  file.refused(":/line", "shape: expected two or three axes of space that are longer than 1, beside which");
  file.refused(":/line", "one of components, found \"6\"");
  file.refused(":/many", "one of components, found \"2 x 2 x 2 x 2 x 2 x 2\"");
  file.refused(":/text", "type: expected integers of 8 to 64 bits or floats of 16 to 64, found text");
  file.refused(":/opaque", "found references");
  file.refused(":/huge", "can fill, found \"1 x 2000000000 x 2000000000\"");
  file.refused(":/over", "each from 1 to 2147483647 and less than 2^63 bytes");
  file.refused(":/none", "expected a dataset, found");
}

TEST_CASE("A bool or enum dataset of HDF5 is refused in words, named or not", "[ingest]") {
  const Hdf5File file;
  const hid_t type = H5Tenum_create(H5T_NATIVE_INT8);  // as h5py stores bool
  for (signed char value = 0; value < 2; ++value) H5Tenum_insert(type, value ? "TRUE" : "FALSE", &value);
  file.add("/mask", {2, 2, 2}, type, type, std::vector<signed char>(8, 1));
  H5Tclose(type);
  file.refused(":/mask", "type: expected integers of 8 to 64 bits or floats of 16 to 64, found an enumeration, which");
  file.refused("", "found none of numbers: /mask holds an enumeration, which is not read; bool of h5py");
}

TEST_CASE("Truncated HDF5 files are refused", "[ingest]") {
  const Hdf5File file;
  file.add("/v", {2, 2, 2}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(8, 1));
  const std::string good = readBytes(file.path);
  for (std::size_t length = 0; length < good.size(); length += 37) {
    writeBytes(file.path, good.substr(0, length));
    CHECK_THROWS_AS(file.read(), IoError);
  }
}
