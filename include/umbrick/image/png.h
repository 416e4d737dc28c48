// PNG files: 8-bit sRGB with straight alpha, as the format wants, from linear premultiplied colour.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "umbrick/image/image.h"
#include "umbrick/image/tone.h"

namespace umbrick {

struct PngOptions {
  ToneMap toneMap = ToneMap::none;
  double exposure = 0;                          // stops: colour is multiplied by 2^exposure before tone mapping
  std::map<std::string, std::string> metadata;  // tEXt entries
};

/// Writes an image of 4 channels (linear premultiplied RGBA), whole or not at all. Tone mapping acts on the colour over
/// its own alpha: it is un-premultiplied, mapped, encoded with the sRGB curve (IEC 61966-2-1) and stored beside alpha.
/// @throw InvalidArgument  not 4 channels; an exposure that exposureFactor refuses
/// @throw IoError          the file could not be written
void writePng(const std::filesystem::path& path, const Image& image, const PngOptions& options = {});

/// Reads 8-bit RGBA and returns linear premultiplied colour. @throw IoError  the file is missing, truncated or no PNG
Image readPng(const std::filesystem::path& path);

}  // namespace umbrick
