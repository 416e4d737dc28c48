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

/// The series of the images of a file, or of a folder and the folders in it, by number and then UID. Each file is
/// opened and read up to its pixels once. Nothing for a folder without a DICOM file.
/// @throw IoError  missing, or a DICOM file that cannot be read
std::optional<std::vector<DicomSeriesFiles>> readDicomSeries(const std::filesystem::path& path);

/// The one that openDicom picks. @throw Error  as openDicom does
DicomSeriesFiles pickSeries(const std::filesystem::path& path, std::vector<DicomSeriesFiles> all,
                            const std::string& series);

std::unique_ptr<VoxelSource> openDicomSeries(const std::filesystem::path& path, DicomSeriesFiles series);

}  // namespace umbrick
