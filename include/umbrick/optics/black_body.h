// The light of glowing matter: colours of black bodies.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

namespace umbrick {

/// Returns the tristimulus values X, Y, Z of a black body: the integral of Planck's law (W / (m^2 sr nm)) times the
/// CIE 1931 2-degree colour matching functions over 360 to 830 nm.
///
/// The functions are the fit of Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
/// Matching Functions", JCGT 2(2), Eq. 4. Against tabulated chromaticities of black bodies, x and y are off by at most
/// 0.006 from 1500 to 10000 K, and by 0.011 at 1000 K, where all light is at the red end.
/// @param kelvin  above 0
glm::dvec3 blackBodyXyz(double kelvin);

/// Returns the colour of a black body as linear sRGB of luminance 1. Colours below some 1900 K lie outside of sRGB, as
/// their blue is negative: that is cut off, and red and green are scaled to the same luminance.
/// @param kelvin  above 0
glm::dvec3 blackBodyColour(double kelvin);

}  // namespace umbrick
