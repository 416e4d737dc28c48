// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_rle.h"

#include <algorithm>
#include <bit>

namespace umbrick {
namespace {

constexpr std::size_t kHeadBytes = 64;  // the number of segments, and where each of up to 15 begins

std::size_t numberAt(std::span<const std::byte> bytes, std::size_t at) {
  std::size_t out = 0;
  for (std::size_t i = 4; i-- > 0;) out = out << 8 | std::to_integer<std::size_t>(bytes[at + i]);
  return out;
}

// Runs: n below 128 is followed by n + 1 bytes as they are, n above it by a byte that is there 257 - n times.
// @return bytes unpacked
std::size_t unpackSegment(std::span<const std::byte> in, std::span<std::byte> out, std::size_t first,
                          std::size_t step) {
  const std::size_t count = out.size() / step;
  std::size_t done = 0;
  for (std::size_t at = 0; at < in.size() && done < count;) {
    const auto n = std::to_integer<std::size_t>(in[at++]);
    if (n == 128) continue;
    const std::size_t run = std::min(n < 128 ? n + 1 : 257 - n, count - done);
    if (at + (n < 128 ? run : 1) > in.size()) break;
    for (std::size_t i = 0; i < run; ++i) out[(done + i) * step + first] = in[n < 128 ? at + i : at];
    at += n < 128 ? n + 1 : 1;
    done += run;
  }
  return done;
}

}  // namespace

std::string unpackDicomRle(std::span<const std::byte> packed, std::size_t pixelBytes, std::span<std::byte> out) {
  if (packed.size() < kHeadBytes) return "the head of RLE data, found " + std::to_string(packed.size()) + " bytes";
  const std::size_t segments = numberAt(packed, 0), pixels = out.size() / pixelBytes;
  if (segments != pixelBytes) return std::to_string(pixelBytes) + " RLE segments, found " + std::to_string(segments);
  for (std::size_t i = 0; i < segments; ++i) {
    const std::size_t begin = numberAt(packed, 4 + 4 * i),
                      end = i + 1 < segments ? numberAt(packed, 8 + 4 * i) : packed.size();
    if (begin < kHeadBytes || end < begin || end > packed.size())
      return "RLE segments one behind the other, found one from byte " + std::to_string(begin) + " to " +
             std::to_string(end);
    const std::size_t first = std::endian::native == std::endian::little ? pixelBytes - 1 - i : i;
    const std::size_t got = unpackSegment(packed.subspan(begin, end - begin), out, first, pixelBytes);
    if (got != pixels) return std::to_string(pixels) + " bytes in an RLE segment, found " + std::to_string(got);
  }
  return {};
}

}  // namespace umbrick
