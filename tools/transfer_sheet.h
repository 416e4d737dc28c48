// Transfer functions as a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/image/image.h"

namespace umbrick::tools {

/// Draws a row for each preset, with its name and values: extinction over the values of its domain as a curve that is
/// filled with the colour, as a share of the largest, and the colours alone below it.
Image drawTransferSheet(const std::vector<std::string>& presets);

}  // namespace umbrick::tools
