// OpenEXR files with layers and text attributes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "umbrick/core/names.h"
#include "umbrick/image/image.h"

namespace umbrick {

/// One layer of a file. The main layer has an empty name, and its channels are R, G, B, A. A layer of one channel
/// is stored as the channel `name` ("depth" as Z when it is called "Z"), one of several channels as `name.R`,
/// `name.G`, and so on.
struct ImageLayer {
  std::string name;
  Image image;
  bool exact = false;  // is stored as float32, whatever ExrOptions::pixel is
};

enum class ExrPixel { half, float32 };
inline constexpr Name<ExrPixel> kExrPixels[]{{"half", ExrPixel::half}, {"float", ExrPixel::float32}};

struct ExrOptions {
  ExrPixel pixel = ExrPixel::half;              // of all layers but "Z" and exact ones: these are float32
  std::map<std::string, std::string> metadata;  // string attributes of the header, such as {"umbrick.scene", json}
};

struct ExrFile {
  std::vector<ImageLayer> layers;  // the main layer first
  std::map<std::string, std::string> metadata;
};

/// Writes all layers, which have one size, as one part with scan lines from the top as the format wants. The file is
/// written whole or not at all. Half floats clamp finite values beyond 65504 to it.
/// @throw InvalidArgument  no layers, sizes that differ, or two layers of one name
/// @throw IoError          the file could not be written; the message names it and what failed
void writeExr(const std::filesystem::path& path, const std::vector<ImageLayer>& layers, const ExrOptions& options = {});

/// @throw IoError  the file is missing, truncated, or not an EXR file that holds scan lines
ExrFile readExr(const std::filesystem::path& path);

}  // namespace umbrick
