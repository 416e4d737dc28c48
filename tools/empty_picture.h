// Tells what to do about a picture in which nothing can be seen.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "umbrick/image/image.h"
#include "umbrick/render/volume.h"

namespace umbrick::tools {

/// Returns a line about a picture whose alpha is nowhere above 1/255, or everywhere 1: what the values of the volume
/// are, where the transfer function shows something, and what to try. Nothing for other pictures. Before a background
/// (where all pixels are opaque) a picture is empty when it is the background everywhere.
std::optional<std::string> describeEmptyPicture(const Image& colour, const ResolvedScene& scene, const Volume& volume);

}  // namespace umbrick::tools
