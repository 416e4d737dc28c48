// The pixels of a DICOM file. Only the .cpp sees GDCM, which unpacks them.
//
// DCMTK 3.6.7 was tried beside GDCM 3.0.21 on 13 small files and 2080 damaged copies of them. DCMTK never crashed and
// took at most 24 MB, while GDCM alone ended by an assertion on 4 of the first 17 files, which is why dicom_elements.h
// reads the headers. But DCMTK as Debian builds it decodes no JPEG 2000, and it gave 36 damaged files pixels that are
// not as many as their tags say, so checks would be needed as well.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "ingest/dicom/dicom_file.h"

namespace umbrick {

/// The pixels of picture `image` as pixels.layout says, with pixels.samples numbers side by side; those of all pictures
/// where a picture cannot be had without the others (DicomPixelData::single). Several threads may call it at once.
/// @throw IoError  unreadable, a transfer syntax that is not decoded, or not as many pixels as the tags say
std::vector<std::byte> readDicomPixels(const DicomFile& file, std::size_t image);

}  // namespace umbrick
