// DICOM segmentations of two segments, whose pixels are known.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "ingest/dicom_files.h"

namespace umbrick::dicom_files {

struct Shown {
  int segment = 1;
  double place = 0;  // mm along the normal
};

// Which pixels of a frame are set: another pattern for each.
inline bool isSet(std::size_t frame, int x, int y) { return (x + 2 * y + 3 * int(frame)) % 5 == 0; }

inline std::string us(std::initializer_list<std::uint16_t> values) {
  return bytesOf(std::vector<std::uint16_t>(values));
}

// Frames follow each other bit by bit: 12 x 10 pixels are no whole number of bytes.
inline std::string bitsOf(std::size_t frames) {
  std::string out((frames * kColumns * kRows + 7) / 8, '\0');
  for (std::size_t i = 0; i < frames * kColumns * kRows; ++i) {
    const std::size_t pixel = i % (kColumns * kRows);
    if (isSet(i / (kColumns * kRows), int(pixel % kColumns), int(pixel / kColumns)))
      out[i / 8] = static_cast<char>(out[i / 8] | 1 << (i % 8));
  }
  return out.size() % 2 ? out + '\0' : out;
}

inline Elements segmentation(const std::vector<Shown>& frames, bool fractional = false) {
  Elements file = slice(0, glm::dvec3(0));
  file.text(8, 0x60, "CS", "SEG")
      .text(0x28, 8, "IS", std::to_string(frames.size()))
      .remove(0x20, 0x32)
      .remove(0x20, 0x37);
  file.remove(0x28, 0x30).remove(0x28, 0x1052).remove(0x28, 0x1053).number(0x28, 0x103, 0);
  const std::uint16_t bits = fractional ? 8 : 1;
  file.number(0x28, 0x100, bits).number(0x28, 0x101, bits).number(0x28, 0x102, bits - 1);
  file.text(0x62, 1, "CS", fractional ? "FRACTIONAL" : "BINARY");
  if (fractional) file.number(0x62, 0xe, 200);
  // D50 white and a red.
  file.sequence(
      0x62, 2,
      {Elements().number(0x62, 4, 1).text(0x62, 5, "LO", "liver").put(0x62, 0xd, "US", us({65535, 32896, 32896})),
       Elements().number(0x62, 4, 2).text(0x62, 5, "LO", "vessel")});
  Elements shared;
  shared.sequence(0x20, 0x9116, {Elements().text(0x20, 0x37, "DS", numbers(kOrientation))})
      .sequence(0x28, 0x9110, {Elements().text(0x28, 0x30, "DS", "0.75\\0.5").text(0x18, 0x50, "DS", "2.5")});
  file.sequence(0x5200, 0x9229, {shared});
  std::vector<Elements> each;
  for (const Shown& frame : frames) {
    const glm::dvec3 at = glm::dvec3(1, 2, 3) + frame.place * kNormal;
    each.push_back(Elements()
                       .sequence(0x20, 0x9113, {Elements().text(0x20, 0x32, "DS", numbers({at.x, at.y, at.z}))})
                       .sequence(0x62, 0xa, {Elements().number(0x62, 0xb, static_cast<std::uint16_t>(frame.segment))}));
  }
  file.sequence(0x5200, 0x9230, each);
  if (!fractional) return file.put(0x7fe0, 0x10, "OB", bitsOf(frames.size()));
  std::string bytes;
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) bytes += static_cast<char>(isSet(i, x, y) ? 50 : 0);
  return file.put(0x7fe0, 0x10, "OB", bytes);
}

}  // namespace umbrick::dicom_files
