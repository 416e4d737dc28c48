// Which axes of an HDF5 dataset are those of space, of frames and of components.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ingest/volume_time.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// The lengths of the axes of a dataset; none for a single value.
std::vector<hsize_t> hdf5Shape(hid_t dataset);

/// "5 x 4 x 3"
std::string hdf5ShapeText(const std::vector<hsize_t>& shape);

struct Hdf5Axes {
  std::vector<std::size_t> space;  // places in the shape: z, y and x, or y and x
  std::optional<std::size_t> frames = {}, components = {};
  VoxelMeaning meaning = VoxelMeaning::scalar;  // of the components, where the name of their axis says it
  VolumeTimes times = {};                       // of frames, or of the only one, from the scale of their axis
  std::vector<std::string> notes = {};          // why an axis was taken for what it is, a line each
  bool isVolume() const { return space.size() == 2 || space.size() == 3; }
  bool isPlain() const { return space.size() == 3 && !frames && !components; }
};

/// Tells the axes apart, by their names first: those of dimension scales, which netCDF-4 has for each axis, or labels.
/// - Components are the axis that is called so (component, vector, rgb, channel and the like). Of more than three axes
///   that are longer than 1 it is the last one, if that has a length of 2 to 4 and no other name of its own.
/// - Frames are, of four axes and more, the axis that is called so (time, t, frame), or the one whose scale states a
///   time as CF has it. Of more than three axes that are longer than 1 it is the only one that is unlimited, else the
///   first.
/// - The others are those of space. Of more than three, those of length 1 are dropped, the first ones first.
/// Sources: https://docs.hdfgroup.org/hdf5/v1_14/group___h5_d_s.html (dimension scales and labels),
/// https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html (netCDF-4), and CF conventions 4.4
Hdf5Axes hdf5Axes(hid_t dataset);

}  // namespace umbrick
