// Pictures as a browser shows them: sRGB on the page's dark ground, as JPEG or PNG.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/image/image.h"

namespace umbrick::view {

/// Encodes a picture of 4 channels (linear, premultiplied). @param quality  1 to 100  @throw InvalidArgument
std::string encodeJpeg(const Image& picture, int quality);
/// Encodes it without loss, quickly rather than small. @throw InvalidArgument
std::string encodePng(const Image& picture);

}  // namespace umbrick::view
