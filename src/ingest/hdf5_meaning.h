// What the attributes of an HDF5 or netCDF dataset say of its values and of their place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ingest/streams/decode.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// value = slope * stored + intercept, but for stored values that stand for none.
struct Hdf5Meaning {
  VoxelType read = VoxelType::u8;  // what libhdf5 gives; it would clip signed values to 0 if asked for unsigned ones
  VoxelLayout layout;              // of these values, signed or not
  std::vector<double> missing;
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  /// As decodeVoxels; missing values become NaN.
  double decode(std::span<const std::byte> stored, std::span<float> out) const;
};

/// Reads scale_factor, add_offset, _FillValue, missing_value, valid_min, valid_max, valid_range and _Unsigned of the CF
/// convention, and element_size_um, offset_um, resolution, offset and units, which have a number for each axis. Places
/// the voxels of `info` and adds notes to it.
/// Source: https://cfconventions.org/Data/cf-conventions/cf-conventions-1.11/cf-conventions.html, 2.5 and 8.1
/// @param read  the type in memory  @param axes  of the dataset that are z, y and x  @param rank  of the dataset
/// @throw IoError  attributes that are no such numbers
Hdf5Meaning readHdf5Meaning(hid_t dataset, VoxelType read, const std::vector<std::size_t>& axes, std::size_t rank,
                            VolumeInfo& info);

}  // namespace umbrick
