// DICOM series: the files of a folder, or one file, as a volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct DicomSeries {
  std::string uid, description, modality;
  std::int64_t number = 0;                   // SeriesNumber, which several series may share
  std::vector<std::filesystem::path> files;  // in order of their names
};

/// A folder holds several series and none was picked; the message lists them.
struct SeveralSeries : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};
/// A series has several slices at a position; the message says in which tags they differ, by which `where` can pick.
struct SeveralPhases : IoError {
  using IoError::IoError;
};
/// A few files are damaged or unlike the others: a series that is picked is read without them.
struct OddSlices : IoError {
  using IoError::IoError;
};
/// A series states no spacing or no positions: `spacing` can.
struct UnplacedSlices : IoError {
  using IoError::IoError;
};
/// Slices are missing or not evenly spaced: `evenSlices` interpolates.
struct UnevenSlices : IoError {
  using IoError::IoError;
};

/// A segmentation, whose frames overlap or leave slices out: openDicomSegments reads it.
struct SegmentsFound : IoError {
  using IoError::IoError;
};

struct DicomOptions {
  /// The UID of a series or its place in the list, from 1; empty for the only one. Of a series that is picked, damaged
  /// files and slices unlike most of the others, such as a localizer, are left out.
  std::string series = {};
  /// Only slices for which all of these hold: "Tag=value", the tag by its keyword or as "gggg,eeee".
  std::vector<std::string> where = {};
  /// Of a series that states none: between columns, rows and slices, mm. Slices without positions follow each other by
  /// InstanceNumber from `origin` on, which is 0 where there is none.
  std::optional<glm::dvec3> spacing = {};
  std::optional<glm::dvec3> origin = {};
  /// Spacing and origin are taken where the series states none, and are no mistake where it does.
  bool overridePlace = false;
  /// Slices that are not evenly spaced are interpolated, linearly along the normal, to even ones.
  bool evenSlices = false;
  PartChoice parts = {};  // of colours
};

/// Lists the series of a folder and the folders in it, by number and then UID, or the one of a file. Files that are no
/// DICOM or damaged are passed over.
/// @throw IoError  the path is missing or cannot be read
std::vector<DicomSeries> listDicomSeries(const std::filesystem::path& path);

/// Opens a series of grey or coloured slices in files of one frame or of many, also enhanced ones and Siemens mosaics.
/// Every transfer syntax is read that GDCM decodes (raw of both byte orders, RLE, JPEG, JPEG-LS, JPEG 2000), and
/// deflated data sets. Colours (RGB, YBR_FULL and PALETTE COLOR) become red, green and blue, of 8 or 16 bits; those of
/// three samples are not packed, or by run lengths. A file may lack its preamble, and have bytes behind its pixels or
/// zeros behind its end.
///
/// Slices are put in order of their positions along the normal of their plane, whatever their names and numbers. World
/// space is the patient's LPS in mm: x and y are the directions of rows and columns times PixelSpacing, z is the step
/// from slice to slice, so that the slices of a tilted gantry give a sheared volume. Positions must fit that step to 2%
/// of it, to 0.01 mm, or to the digits in which they are written: a slice that is missing, twice there or out of line
/// is an error, never a stretched volume. Rescale slope and intercept are applied slice by slice. All cores read
/// headers and unpack slices, those of a slab at a time. Source: DICOM PS3.3 C.7.6.2 (image plane), C.11.1 (modality
/// LUT), C.7.6.16 (functional groups)
///
/// @throw SeveralSeries    there are several series and none is picked
/// @throw InvalidArgument  there is no such series or value, the message lists those there are; spacing or origin of a
///                         series that states its own
/// @throw SeveralParts     colours, of which `parts` chooses none
/// @throw IoError          missing, unreadable, colours of other kinds, slices of different kinds, positions that make
/// no volume; of the
///                         types above where an option helps
std::unique_ptr<VoxelSource> openDicom(const std::filesystem::path& path, const DicomOptions& options = {});

}  // namespace umbrick
