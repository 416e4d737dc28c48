// The frames of a DICOM file: where each lies, how it is rescaled, and the values by which it may be picked.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_tags.h"

namespace umbrick {

/// Fills file.frames, one for each picture of file.pixels, and what the file says of their distance.
/// Source: DICOM PS3.3 C.7.6.2 (image plane), C.7.6.16 (functional groups), C.8.4.8, C.8.4.11 and C.8.4.15 (nuclear
/// medicine: vectors of frames, detectors, and slices that follow each other against the normal), C.8.8.3 (dose)
/// @throw IoError  frames that are no slices, or fields of the wrong kind
void readDicomFrames(const DicomTags& tags, DicomFile& file);

/// The values of at most `longest` characters, without those of patients and pixels.
DicomValues shortValues(const DicomElements& elements, std::size_t longest);

/// rows x columns, at right angles to both.
glm::dvec3 sliceNormal(const DicomFrame& frame);

}  // namespace umbrick
