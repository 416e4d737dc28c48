// The tags of DICOM by their keywords. Only the .cpp sees GDCM, which has the dictionary of the standard.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace umbrick {

/// The value representation of a tag of the standard, "UN" for others.
std::array<char, 2> dicomKind(std::uint32_t tag);

/// "AcquisitionNumber" of 0x00200012; "(0019,100c)" of a tag without a keyword.
std::string dicomKeyword(std::uint32_t tag);

/// The tag of a keyword, or of "0019,100c", with or without parentheses, in any case. Nothing where it is neither.
std::optional<std::uint32_t> dicomTag(const std::string& name);

}  // namespace umbrick
