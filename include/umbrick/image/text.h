// Lines of text as masks, in a font that is part of the library.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/image/image.h"

namespace umbrick {

/// The shape of a line of text.
struct TextMask {
  Image coverage;    // 1 channel: the share of each pixel that letters cover, in [0, 1]; empty where there is nothing
  int left = 0;      // pixels from where the line begins to the first column of the mask; may be negative
  int bottom = 0;    // pixels from the base line to the lowest row of the mask, mostly negative
  double width = 0;  // how far the line advances, pixels
};

/// Draws a line of text in Bitstream Vera Sans, whose copyright notice stands in the font's own table of names. It is
/// embedded by the build and rasterised by stb_truetype, so that no font is looked for at run time. Letters that it
/// does not have (it covers Latin-1) are boxes.
/// @param utf8  one line; bytes that are not UTF-8 are boxes, too
/// @param em    height of the font, pixels; a capital letter has 0.73 of it, a digit as much
/// @throw InvalidArgument  em is not in [1, 4096]
TextMask textMask(const std::string& utf8, double em);

}  // namespace umbrick
