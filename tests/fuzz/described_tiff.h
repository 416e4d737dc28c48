// A TIFF of one directory, 2 x 2 pixels of 8 bits, with a description. Slices without directories follow.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace umbrick {

/// @param pixels  four for each slice, the first of which has the directory
inline std::string describedTiff(std::string_view description, const std::string& pixels) {
  std::string out("II*\0\x08\0\0\0", 8);
  const auto number = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
  };
  constexpr std::uint32_t kEntries = 10, kEnd = 8 + 2 + 12 * kEntries + 4;
  const std::string text = std::string(description) + std::string(4, '\0');  // a longer one than fits into its entry
  const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
    number(tag, 2);
    number(type, 2);
    number(count, 4);
    number(value, 4);
  };
  constexpr std::uint32_t kShort = 3, kLong = 4, kText = 2;
  const auto textBytes = static_cast<std::uint32_t>(text.size());
  number(kEntries, 2);
  entry(256, kShort, 1, 2);  // width
  entry(257, kShort, 1, 2);  // height
  entry(258, kShort, 1, 8);  // bits
  entry(259, kShort, 1, 1);  // not packed
  entry(262, kShort, 1, 1);  // black is zero
  entry(270, kText, textBytes, kEnd);
  entry(273, kLong, 1, kEnd + textBytes);  // where the strip is
  entry(277, kShort, 1, 1);                // samples
  entry(278, kShort, 1, 2);                // rows of the strip
  entry(279, kLong, 1, 4);                 // its bytes
  number(0, 4);
  return out + text + pixels;
}

}  // namespace umbrick
