// How a projected value is shown.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>

#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// Returns linear RGBA, opaque: the function's albedo at the value (of a 2D function at gradient 0), darkened by where
/// the value lies in the function's domain, which is the window. A PNG of a white function shows value and grey level
/// in proportion, from black at the lower end of the window to white at the upper one, as viewers of medical pictures
/// do.
glm::dvec4 projectionColour(const TransferFunction& transfer, double value);

/// Tells whether a projected value is that of empty space, which is not shown: within a millionth of the window, since
/// sums of voxels are rounded.
bool isBackground(const TransferFunction& transfer, double value, double background);

/// Returns linear RGBA, opaque, of a share of light that gets through: as an X-ray film, black where all of it does.
glm::dvec4 xrayColour(double through);

}  // namespace umbrick
