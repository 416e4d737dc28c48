// Which series a file or a folder holds, and the tags of their files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dicom/dicom_file.h"
#include "umbrick/ingest/dicom_volume.h"

namespace umbrick {

struct DicomSeriesFiles {
  DicomSeries series;
  std::vector<DicomFile> files;  // as series.files
};

struct DicomFolder {
  std::vector<DicomSeriesFiles> series;  // by number and then UID; each has a file that is whole
  std::vector<DicomFile> damaged;        // files of no series that is there
};

/// The series of the images of a file, or of a folder and the folders in it. The header of each file is read once, by
/// all cores. Nothing for a folder without a DICOM file.
/// @throw IoError  missing or not to be opened; a single file that is damaged; a folder of files that are named as
/// DICOM
///                 and have no header of it
std::optional<DicomFolder> readDicomFolder(const std::filesystem::path& path);

/// Opens the series that the options pick. @throw Error  as openDicom does
std::unique_ptr<VoxelSource> openDicomFolder(const std::filesystem::path& path, DicomFolder folder,
                                             const DicomOptions& options);

}  // namespace umbrick
