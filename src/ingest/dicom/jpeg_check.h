// Whether the entropy-coded data of a JPEG stream are whole.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace umbrick {

/// GDCM decodes a damaged JPEG to grey and says so on stderr alone, so the codes are followed here before. Looks at
/// streams of one component with Huffman codes, baseline, extended or lossless; takes others as they are.
/// Source: ITU-T T.81, Annexes C, F.2.2 and H.2
///
/// @return what is wrong, if anything is: data that end early or are left over, codes or markers that there are not
std::optional<std::string> jpegDamage(std::span<const std::byte> stream);

}  // namespace umbrick
