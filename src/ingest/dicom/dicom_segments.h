// The segments that a DICOM segmentation describes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_tags.h"

namespace umbrick {

/// Fills file.segments and file.wholeSegment; of other files nothing. Source: DICOM PS3.3 C.8.20.2
void readDicomSegments(const DicomTags& tags, DicomFile& file);

/// A colour of CIE L*a*b* as DICOM writes it, three numbers of 16 bits under the white D50, in sRGB, each from 0 to 1.
/// Colours beyond sRGB are cut off. Sources: DICOM PS3.3 C.10.7.1.1; CIE 15:2004, 8.2.1.1; Bradford adaptation to D65
/// and the matrix of sRGB as in http://www.brucelindbloom.com/Eqn_RGB_XYZ_Matrix.html
glm::dvec3 srgbOfDicomLab(const glm::dvec3& stored);

}  // namespace umbrick
