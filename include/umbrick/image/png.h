// PNG files: 8-bit sRGB with straight alpha, as the format wants, from linear premultiplied colour.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "umbrick/image/image.h"

namespace umbrick {

enum class ToneMap {
  none,      // clamp at 1
  reinhard,  // c / (1 + luminance)
  filmic,    // Hable 2010 or a fit of the ACES curve; the source is named where it is implemented
};

struct PngOptions {
  ToneMap toneMap = ToneMap::none;
  float exposure = 0;                           // stops: colour times 2^exposure before tone mapping
  std::map<std::string, std::string> metadata;  // tEXt entries
};

/// Writes an image of 4 channels (linear premultiplied RGBA). Tone mapping acts on the colour over its own alpha:
/// un-premultiplied, mapped, encoded with the sRGB curve (IEC 61966-2-1), stored beside alpha. Nothing half-written.
/// @throw InvalidArgument  not 4 channels
/// @throw IoError
void writePng(const std::filesystem::path& path, const Image& image, const PngOptions& options = {});

/// Reads 8-bit RGBA back to linear premultiplied. @throw IoError
Image readPng(const std::filesystem::path& path);

}  // namespace umbrick
