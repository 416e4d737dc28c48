// Interpolation of display colours in the spaces that ParaView names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

namespace umbrick {

/// step: the second colour, as VTK has it. hsv: through the hues between the two; hsvWrap: the short way round.
enum class ColourSpace { rgb, hsv, hsvWrap, lab, diverging, step };

/// Between two sRGB display colours, `t` in [0, 1]. The result is a display colour in [0, 1] (clamped to the gamut).
/// lab: CIE 1976 L*a*b*, white D65. diverging: Moreland 2009, "Diverging Color Maps for Scientific Visualization",
/// doi:10.1007/978-3-642-10520-3_9: polar Lab, through white where the hues differ enough.
glm::dvec3 mixColours(const glm::dvec3& from, const glm::dvec3& to, double t, ColourSpace space);

}  // namespace umbrick
