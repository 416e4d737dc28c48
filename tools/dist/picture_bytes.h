// A picture as bytes, by which one rank hands it to another.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "umbrick/draw/renderer.h"

namespace umbrick::tools {

/// Returns all of a picture, its statistics too, as numbers are in memory: for processes of one program.
std::string bytesOfPicture(const Picture& picture);
/// @throw Error  bytes of something else
Picture pictureOfBytes(std::string_view bytes);

}  // namespace umbrick::tools
