// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/hdf5_volume.h"

#include <hdf5.h>

#include <catch2/catch.hpp>
#include <numeric>

#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

struct Hdf5File {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.h5";

  Hdf5File() { H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)); }

  /// @param chunk  empty: contiguous; else packed by gzip in chunks of that shape
  template <class T>
  void add(const char* name, const std::vector<hsize_t>& shape, hid_t stored, hid_t type, const std::vector<T>& values,
           const std::vector<hsize_t>& chunk = {}) const {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE), links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    if (!chunk.empty()) {
      H5Pset_chunk(how, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_deflate(how, 6);
    }
    const hid_t set = H5Dcreate2(file, name, stored, space, links, how, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
    H5Pclose(how);
    H5Pclose(links);
    H5Sclose(space);
    H5Fclose(file);
  }
  std::vector<float> read(const std::string& dataset = {}) const {
    return readVolume(*openVolume(path.string() + dataset));
  }
  void refused(const std::string& dataset, const std::string& message) const {
    CHECK_THROWS_AS(read(dataset), IoError);
    CHECK_THROWS_WITH(read(dataset), Contains(message) && Contains(path.string()));
  }
};

}  // namespace

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
  CHECK(source->info().metadata.at("hdf5_dataset") == "/a/volume");
  CHECK(readVolume(*source) == std::vector<float>(values.begin(), values.end()));
  const auto again = openVolume(file.path.string() + ":/a/volume");
  again->skipSlices(6);
  std::vector<float> last(30);
  again->readSlab(1, last);
  CHECK(last == std::vector<float>(values.end() - 30, values.end()));
}

TEST_CASE("What is no volume in an HDF5 file is refused with both values", "[ingest]") {
  const Hdf5File file;
  file.refused("", "found none");
  file.add("/line", {6}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(6));
  file.add("/many", {2, 2, 2, 2}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>(16));
  file.add("/text", {1, 1, 1}, H5T_C_S1, H5T_C_S1, std::vector<char>{'a'});
  file.add("/opaque", {1, 1, 1}, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, std::vector<char>{});
  file.add("/huge", {1, 2000000000, 2000000000}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>{}, {1, 64, 64});
  file.add("/over", {3000000000, 3000000000, 3000000000}, H5T_STD_U8LE, H5T_NATIVE_INT, std::vector<int>{}, {1, 8, 8});
  file.refused(":/line", "shape: expected two or three axes, found \"6\"");
  file.refused(":/many", "shape: expected two or three axes, found \"2 x 2 x 2 x 2\"");
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
