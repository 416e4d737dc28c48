// Slices of one size, type, orientation and spacing, and the few in a series that are unlike most.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ingest/dicom/dicom_file.h"

namespace umbrick {

/// Checks that planes are those of images: positive spacing, two unit vectors at right angles.
/// @throw IoError  a field that is none
void checkPlanes(const std::vector<DicomFile>& files);

/// Keeps the slices that are like most of the others where `leaveOut` is set, and says in notes which go.
/// @throw OddSlices  where it is not, and most slices are alike: the message names one of the others
/// @throw IoError    there is no half of the slices that are alike
void keepAlike(std::vector<DicomFile>& files, bool leaveOut, std::vector<std::string>& notes);

/// "image.dcm", or "image.dcm frame 3" of a file with several.
std::string sliceName(const DicomFile& file, const DicomFrame& frame);

std::string pointText(const glm::dvec3& v);

}  // namespace umbrick
