// FLIP: how much a viewer who flips between two pictures sees them differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/image/image.h"

namespace umbrick {

/// Pixels per degree of visual angle, as seen from 0.7 m at a display that is 0.7 m wide and has 3840 pixels
/// across: 67.02.
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

/// Returns the error of every pixel in [0, 1], as 1 channel. Its mean is the FLIP of the two pictures.
///
/// Both pictures are taken as a screen shows them: over `background`, clamped to [0, 1] without tone mapping, NaN as 0.
/// Then, per pixel,
///   colour:   YCxCz filtered with the eye's contrast sensitivity, CIELAB with Hunt's adjustment, HyAB distance ^ 0.7,
///             spread over [0, 1] (p_c = 0.4, p_t = 0.95)                                          dE_c
///   features: the larger change of edges and points in Y (w = 0.082 degrees), / sqrt(2), ^ 0.5    dE_f
///   FLIP = dE_c ^ (1 - dE_f)
/// Pictures continue beyond their border with its pixels. This is LDR-FLIP: Andersson, Nilsson, Akenine-Moller,
/// Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images", doi:10.1145/3406183.
///
/// @param test, reference  linear premultiplied RGBA, or RGB
/// @param background       linear RGB in [0, 1]
/// @param pixelsPerDegree  in [1, 1000]
/// @throw InvalidArgument  no pixels, sizes or channel counts that differ, not 3 or 4 channels, an option out of range
Image flipMap(const Image& test, const Image& reference, const glm::dvec3& background = glm::dvec3(0),
              double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace umbrick
