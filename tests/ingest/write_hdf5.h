// HDF5 files that tests write by libhdf5.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick {

struct Hdf5File {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.h5";

  Hdf5File() { H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)); }

  /// @param chunk  empty: contiguous; else packed by gzip in chunks of that shape
  /// @param most   what the axes can grow to; empty: they cannot
  template <class T>
  void add(const char* name, const std::vector<hsize_t>& shape, hid_t stored, hid_t type, const std::vector<T>& values,
           const std::vector<hsize_t>& chunk = {}, const std::vector<hsize_t>& most = {}) const {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t space =
        H5Screate_simple(static_cast<int>(shape.size()), shape.data(), most.empty() ? nullptr : most.data());
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
    CHECK_THROWS_WITH(read(dataset), Catch::Contains(message) && Catch::Contains(path.string()));
  }
};

// Gives a dataset an attribute of numbers, or of text.
template <class T>
void describe(const Hdf5File& file, const char* dataset, const char* key, hid_t stored, const std::vector<T>& values) {
  const hid_t opened = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(opened, dataset, H5P_DEFAULT);
  const hsize_t count = values.size();
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(set, key, stored, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, std::is_floating_point_v<T> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT, values.data());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(opened);
}

inline void describe(const Hdf5File& file, const char* dataset, const char* key, const char* text) {
  const hid_t opened = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(opened, dataset, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t attribute = H5Acreate2(set, key, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, &text);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(opened);
}

}  // namespace umbrick
