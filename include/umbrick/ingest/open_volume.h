// Volumes of any format, told by name and first bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/ingest/array_volume.h"
#include "umbrick/ingest/raw_volume.h"
#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct OpenOptions {
  std::optional<RawOptions> raw = {};  // when given, the file is read as headerless raw, whatever its name
  /// When given, voxels are read from memory, and the path is but their name. lengthUnit and space are then what its
  /// world has.
  std::optional<ArrayVolume> array = {};
  bool strict = false;  // refuses plain files that go on behind the voxels of their header, or of `raw`: else a note
  /// The unit of length that the world gets: nm, um, mm, cm, m, or "file" for the one that the file states. Where a
  /// file states none, its numbers are taken for this unit. Empty: mm, or smaller where voxels are too small for
  /// OpenVDB.
  std::string lengthUnit = {};
  /// Which way the axes of the world point: three letters such as "LPS" or "RAS". Of a file that does not say it, the
  /// numbers are taken for that space. Empty or "file": as in the file.
  std::string space = {};
  /// Refuses what lies outside of the folder of the file, links and ".." followed: the data files that a header names,
  /// links among the files of a folder, what an HDF5 file takes from others. Without it a header of a stranger can take
  /// the bytes of any readable file into the volume.
  bool besideOnly = false;
  std::string series = {};                 // of DICOM: the UID of a series, or its number in the list, from 1
  std::vector<std::string> where = {};     // of DICOM: only slices with this "Tag=value", see DicomOptions
  bool evenSlices = false;                 // of DICOM: slices that are not evenly spaced are interpolated
  std::optional<glm::dvec3> spacing = {};  // world units between voxel centres, for formats that state no place
  std::optional<glm::dvec3> origin = {};   // world position of the first voxel's centre, for the same formats
  /// Spacing and origin also take the place of what the file states. They are in the unit that the file states; the
  /// directions of its axes stay.
  bool overridePlace = false;
  PartChoice parts = {};  // of files of several volumes, or of several numbers a voxel
};

/// No format is known by the name or the first bytes of the file: OpenOptions::raw has to say what its bytes mean.
struct UnknownFormat : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// A place was given for a file that states its own: OpenOptions::overridePlace takes the one that was given.
struct StatedPlace : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// Opens a volume. Its format is told by the extension of its name, or else by its first bytes.
/// @throw UnknownFormat    no format is known by that name or those bytes, and `raw` is not given
/// @throw StatedPlace      spacing or origin for a format that states its own, without overridePlace
/// @throw InvalidArgument  they are not positive and finite; there is no such space; the formats throw it too
/// @throw SeveralParts     several volumes, or several numbers a voxel, and `parts` chooses none
/// @throw IoError          as the formats do
std::unique_ptr<VoxelSource> openVolume(const std::filesystem::path& path, const OpenOptions& options = {});

/// What openVolume would say of the whole file, whatever `parts` chooses: its first frame with all components.
/// @throw Error  as openVolume does
VolumeInfo describeVolume(const std::filesystem::path& path, OpenOptions options = {});

/// The name of the format that the extension of `path` stands for, or nothing.
std::optional<std::string> formatOfName(const std::filesystem::path& path);

/// The same for a file or folder that is there, also by its first bytes.
/// @throw IoError  it cannot be read
std::optional<std::string> formatOfFile(const std::filesystem::path& path);

struct FormatRow {
  std::string name;
  std::vector<std::string> extensions;  // in lower case, with their dot
  std::string reads;                    // what is read of the format, in one line
};
/// The formats that openVolume reads.
std::vector<FormatRow> listFormats();

}  // namespace umbrick
