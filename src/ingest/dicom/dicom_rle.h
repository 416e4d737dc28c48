// RLE pixels of DICOM: GDCM's decoder ends the program by an assertion where the runs do not add up.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace umbrick {

/// Unpacks the bytes of one picture: a segment for each byte of a pixel, the highest first. Source: DICOM PS3.5 Annex G
/// @param out  pixels of `pixelBytes` each, in the byte order of this machine
/// @return what is wrong, or nothing
std::string unpackDicomRle(std::span<const std::byte> packed, std::size_t pixelBytes, std::span<std::byte> out);

}  // namespace umbrick
