// Interpolation of display colours in the spaces that ParaView names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

namespace umbrick {

/// The names mean: step takes the second colour, as VTK has it; hsv goes through the hues between the two, and hsvWrap
/// the short way round.
enum class ColourSpace { rgb, hsv, hsvWrap, lab, diverging, step };

/// Mixes two sRGB display colours, with `t` in [0, 1]. The result is a display colour in [0, 1] (clamped to the gamut).
/// lab is CIE 1976 L*a*b* with the white D65. diverging is polar Lab, through white where the hues differ enough:
/// Moreland 2009, "Diverging Color Maps for Scientific Visualization", doi:10.1007/978-3-642-10520-3_9.
glm::dvec3 mixColours(const glm::dvec3& from, const glm::dvec3& to, double t, ColourSpace space);

}  // namespace umbrick
