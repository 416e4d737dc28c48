// Measures how finely the driver places samples between texels, and how far rounding moves them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/brick/bricks.h"
#include "umbrick/gl/context.h"

namespace umbrick {

/// Returns the largest error of the driver's linear interpolation, as a displacement in voxels: about 1e-7 in software,
/// 1/512 where weights have 8 bits.
/// @param texels  format of the texels that are filtered, see BrickSettings
double samplerPrecision(const GlContext& context, const Bricks& volume, const std::string& texels);

/// Returns how far rounding moves a sample along an axis, voxels. A texture coordinate is a sum of two rounded products
/// and a rounded offset, of magnitudes up to the texture's edge plus the way from the middle of the image, and is
/// rounded again when it is scaled to texels. This makes eight times half a unit in the last of 24 bits, which is 2^-25
/// of the number.
inline double coordinateError(double textureEdge, double sideways) { return 8 * 0x1p-25 * (textureEdge + sideways); }

}  // namespace umbrick
