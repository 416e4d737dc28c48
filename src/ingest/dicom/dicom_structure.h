// How the data elements of a DICOM file follow each other, checked before GDCM reads it: its Debian build ends the
// program by an assertion when it meets an element that cannot be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>

namespace umbrick {

struct DicomStructure {
  std::string transferSyntax;  // UID
  bool bigEndian = false;
  bool encapsulated = false;                      // pixels are packed, in fragments
  std::int64_t pixelOffset = -1, pixelBytes = 0;  // of native PixelData in the file; -1: there is none
  std::int64_t rows = 0;                          // 0: no image, such as a report
};

/// Walks all elements, also of sequences, of the file at `path` that `in` has open. Source: DICOM PS3.5 7.1 to 7.5,
/// PS3.10 7.1
/// @throw IoError  the file is no DICOM, an element is none or ends beyond what holds it, or the data set is deflated
DicomStructure readDicomStructure(const std::filesystem::path& path, std::istream& in);

}  // namespace umbrick
