// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "umbrick/core/error.h"

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace umbrick {

std::span<const unsigned char> labelFont();  // embedded by src/image/CMakeLists.txt

namespace {

constexpr int kUnknown = 0xfffd;  // no letter of the font, so that its box is drawn

// Returns the code points of a text.
std::vector<int> codePoints(const std::string& utf8) {
  std::vector<int> points;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i++]);
    if (lead < 0x80) {
      points.push_back(lead);
      continue;
    }
    const int more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
    int point = lead & (0x3f >> more);
    int taken = 0;
    for (; taken < more && i < utf8.size() && (static_cast<unsigned char>(utf8[i]) & 0xc0) == 0x80; ++taken)
      point = point << 6 | (static_cast<unsigned char>(utf8[i++]) & 0x3f);
    points.push_back(more > 0 && taken == more ? point : kUnknown);
  }
  return points;
}

// A letter, and where it begins on the line.
struct PlacedLetter {
  int glyph;
  double x;
};

struct Line {
  stbtt_fontinfo font{};
  float scale = 0;
  std::vector<PlacedLetter> letters;
  double width = 0;
};

Line lineOf(const std::string& utf8, double em) {
  Line line;
  if (!stbtt_InitFont(&line.font, labelFont().data(), 0)) throw InvalidArgument("text: the embedded font is damaged");
  line.scale = stbtt_ScaleForMappingEmToPixels(&line.font, static_cast<float>(em));
  int before = -1;
  for (const int point : codePoints(utf8)) {
    const int glyph = stbtt_FindGlyphIndex(&line.font, point);
    if (before >= 0) line.width += line.scale * stbtt_GetGlyphKernAdvance(&line.font, before, glyph);
    line.letters.push_back({glyph, line.width});
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&line.font, glyph, &advance, &bearing);
    line.width += line.scale * advance;
    before = glyph;
  }
  return line;
}

}  // namespace

TextMask textMask(const std::string& utf8, double em) {
  if (!(em >= 1 && em <= 4096))
    throw InvalidArgument("text: the font is " + std::to_string(em) + " pixels high, must be 1 to 4096");
  const Line line = lineOf(utf8, em);
  TextMask mask;
  mask.width = line.width;
  // Boxes of letters in pixels, with y downwards from the base line as in the font.
  struct Box {
    int x0, y0, x1, y1;
  };
  std::vector<Box> boxes;
  Box all{0, 0, 0, 0};
  for (const PlacedLetter& letter : line.letters) {
    const auto whole = static_cast<int>(std::floor(letter.x));
    const auto part = static_cast<float>(letter.x - whole);
    Box box{};
    stbtt_GetGlyphBitmapBoxSubpixel(&line.font, letter.glyph, line.scale, line.scale, part, 0, &box.x0, &box.y0,
                                    &box.x1, &box.y1);
    box.x0 += whole;
    box.x1 += whole;
    boxes.push_back(box);
    if (box.x1 <= box.x0 || box.y1 <= box.y0) continue;
    if (all.x1 <= all.x0)
      all = box;
    else
      all = {std::min(all.x0, box.x0), std::min(all.y0, box.y0), std::max(all.x1, box.x1), std::max(all.y1, box.y1)};
  }
  mask.left = all.x0;
  mask.bottom = -all.y1;
  mask.coverage = Image(all.x1 - all.x0, all.y1 - all.y0, 1);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    const int width = box.x1 - box.x0, height = box.y1 - box.y0;
    if (width <= 0 || height <= 0) continue;
    bytes.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    const auto part = static_cast<float>(line.letters[i].x - std::floor(line.letters[i].x));
    stbtt_MakeGlyphBitmapSubpixel(&line.font, bytes.data(), width, height, width, line.scale, line.scale, part, 0,
                                  line.letters[i].glyph);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float& target = *mask.coverage.at(box.x0 - all.x0 + x, all.y1 - 1 - (box.y0 + y));
        const float covered =
            bytes[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] / 255.0f;
        target = std::max(target, covered);  // neighbours may overlap by a fraction of a pixel
      }
  }
  return mask;
}

}  // namespace umbrick
