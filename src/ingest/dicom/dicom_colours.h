// Colours of DICOM pictures: samples of their own, or places in a palette.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "ingest/dicom/dicom_file.h"
#include "ingest/dicom/dicom_tags.h"

namespace umbrick {

/// Finds out what the pixels of a picture are, and reads its palette. Sets file.pixels but for the layout.
/// Source: DICOM PS3.3 C.7.6.3.1.2 (photometric interpretation) and C.7.6.3.1.5 and 6 (palettes)
/// @throw IoError  a photometric interpretation that is not read, with its name, or a palette that is none
void readDicomColours(const DicomElements& elements, const DicomTags& tags, DicomFile& file);

/// The type of the numbers that coloursOf gives, or of the pixels where they are grey.
VoxelType valueType(const DicomPixelData& pixels);

/// Red, green and blue of each pixel, side by side, as numbers of valueType in the byte order of this machine.
/// @param stored  pixels as the file has them: interleaved samples, or places in the palette
std::vector<std::byte> coloursOf(const DicomPixelData& pixels, const std::vector<std::byte>& stored);

/// Samples that lie plane by plane, put side by side. @param stored  of one picture
std::vector<std::byte> withoutPlanes(const std::vector<std::byte>& stored, std::size_t sampleBytes);

}  // namespace umbrick
