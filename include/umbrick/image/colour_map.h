// Numbers as colours: an image of one channel made visible.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/image/image.h"

namespace umbrick {

/// Returns a colour of the map magma, which goes from black (0) over violet and orange to light yellow (1), in equal
/// steps to the eye.
/// @param share  is clamped to [0, 1]
/// @return sRGB display values in [0, 1], within 2.2 / 255 of the 256 colours of Smith and van der Walt 2015 (CC0)
glm::dvec3 magma(double share);

/// Shows an image of 1 channel through magma. `low` and below it is the first colour of the map, `high` and above it
/// (infinity too) the last one. NaN is green, which the map does not have.
/// @return linear RGBA, opaque; a PNG of it shows the very colours of the map
/// @throw InvalidArgument  not 1 channel, or not low < high and both finite
Image colourMapped(const Image& values, double low, double high);

}  // namespace umbrick
