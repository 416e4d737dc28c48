// DICOM series: the files of a folder, or one file, as a volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "umbrick/core/error.h"
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

/// Lists the series of a folder and the folders in it, by number and then UID, or the one of a file. Files that are no
/// DICOM are passed over.
/// @throw IoError  the path is missing, or a DICOM file cannot be read
std::vector<DicomSeries> listDicomSeries(const std::filesystem::path& path);

/// Opens a series of grey slices in files of one frame or of many, also enhanced ones. Every transfer syntax is read
/// that GDCM decodes (raw of both byte orders, RLE, JPEG, JPEG-LS, JPEG 2000), but for deflated data sets.
///
/// Slices are put in order of their positions along the normal of their plane, whatever their names and numbers. World
/// space is the patient's LPS in mm: x and y are the directions of rows and columns times PixelSpacing, z is the step
/// from slice to slice, so that the slices of a tilted gantry give a sheared volume. Positions must fit that step to 2%
/// of it, or to 0.01 mm: a slice that is missing, twice there or out of line is an error, never a stretched volume.
/// Rescale slope and intercept are applied slice by slice. Each file is opened once for its tags and once more when its
/// pixels are read. One file is decoded at a time; one with packed frames is held as a whole.
/// Source: DICOM PS3.3 C.7.6.2 (image plane), C.11.1 (modality LUT), C.7.6.16 (functional groups)
///
/// @param series  the UID of the series or its place in the list, from 1; empty for the only one
/// @throw SeveralSeries    there are several series and none is picked
/// @throw InvalidArgument  there is no such series; the message lists those there are
/// @throw IoError          missing, unreadable, colour, slices of different kinds, positions that make no volume
std::unique_ptr<VoxelSource> openDicom(const std::filesystem::path& path, const std::string& series = {});

}  // namespace umbrick
