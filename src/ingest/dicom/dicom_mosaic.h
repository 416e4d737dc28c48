// Slices that lie beside each other in one picture, as Siemens MR writes them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_tags.h"

namespace umbrick {

/// Puts a frame for each slice in place of that of the whole picture, where the file is a mosaic. A mosaic of n slices
/// has ceil(sqrt(n)) tiles on a side, row by row from the upper left. ImagePositionPatient is that of a picture of the
/// mosaic's size with the same centre as the first slice.
/// Source: Siemens' private tags as nibabel describes them, https://nipy.org/nibabel/dicom/dicom_mosaic.html
/// @throw IoError  a mosaic that does not say how many slices it has, or whose size does not fit them
void unfoldMosaic(const DicomElements& elements, const DicomTags& tags, DicomFile& file);

}  // namespace umbrick
