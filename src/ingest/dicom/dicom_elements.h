// The data elements of a DICOM file, checked and kept up to the size that headers have, and where its pixels lie.
//
// GDCM has a reader of its own, but its Debian build ends the program by an assertion when it meets an element that
// cannot be, it knows no way round bytes behind the end, and it takes ten times as long.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/streams/byte_stream.h"

namespace umbrick {

struct DicomElement;

/// A data set, or an item of a sequence, in order of tags.
using DicomElements = std::vector<DicomElement>;

struct DicomElement {
  std::uint32_t tag = 0;             // group << 16 | element
  std::array<char, 2> kind{};        // value representation; of implicit ones that of the standard's dictionary
  bool big = false;                  // byte order of numbers
  std::string value;                 // as in the file; empty for pixels and what is longer than a MiB
  std::vector<DicomElements> items;  // of a sequence
};

/// A part of packed pixels.
struct DicomFragment {
  std::int64_t offset = 0, bytes = 0;  // of what it holds, in the file
};

struct DicomHeader {
  std::string transferSyntax;  // UID
  bool preamble = true;        // 128 bytes and "DICM" come first
  bool bigEndian = false;
  bool deflated = false;  // all behind the file meta information is packed; offsets are those of what it unpacks to
  std::int64_t dataOffset = 0;  // of the data set in the file
  DicomElements elements;
  std::int64_t pixelOffset = -1, pixelBytes = 0;  // of native PixelData; -1: there is none
  bool encapsulated = false;                      // pixels are packed, in fragments
  std::string fragmentTable;                      // the basic offset table: 32-bit numbers, or empty
  std::vector<DicomFragment> fragments;
};

/// Walks all elements, also of sequences, of a file. Zeros behind the last element are passed over. A file without
/// preamble is told by the first element of its data set.
/// Source: DICOM PS3.5 7.1 to 7.5 and A.5 (deflated), PS3.10 7.1
/// @param begun  gets what was read before an error, so that a damaged file can be told to be of some series
/// @return nothing where there is no header of DICOM
/// @throw IoError  an element is none or ends beyond what holds it
std::optional<DicomHeader> readDicomHeader(const std::filesystem::path& path, DicomHeader* begun = nullptr);

/// The bytes of the file from an offset of a header on, unpacked where it is deflated.
std::unique_ptr<ByteStream> openDicomBytes(const std::filesystem::path& path, bool deflated, std::int64_t dataOffset,
                                           std::int64_t offset);

/// The element of that tag, or null.
const DicomElement* findElement(const DicomElements& elements, std::uint32_t tag);

/// The value as text, without the blanks around it; binary numbers are written out, with backslashes between several.
/// Empty for sequences and bytes.
std::string elementText(const DicomElement& element);

/// The name of a transfer syntax for people, with its UID.
std::string transferSyntaxName(const std::string& uid);

}  // namespace umbrick
