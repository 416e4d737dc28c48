// Slices of one series by the values of their tags: one phase, one echo, one acquisition.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ingest/dicom/dicom_file.h"

namespace umbrick {

/// Leaves the frames for which all of `where` holds, "Tag=value" each. A value holds where it is the whole text, one of
/// the texts between backslashes, or the same number.
/// @throw InvalidArgument  no tag, or one with which no frame is left; the message lists the values there are
void keepWhere(const std::string& name, std::vector<DicomFile>& files, const std::vector<std::string>& where);

/// A slice of a series: a frame of a file.
struct DicomSlice {
  const DicomFile* file = nullptr;
  const DicomFrame* frame = nullptr;
};

/// Finds tags by whose values slices at the same positions can be told apart. @param places  one number for each
/// position @return "AcquisitionNumber (1, 2), EchoTime (4.6, 9.2)"; empty where there are none
std::string whatDiffers(const std::vector<DicomSlice>& slices, const std::vector<std::size_t>& places);

}  // namespace umbrick
