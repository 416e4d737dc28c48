// Phong's model of reflection.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

/// Returns the share of a light that a surface scatters to all sides. @param normal_light  cosine of their angle
float phongDiffuse(float normal_light);

/// Returns the share of a light that a surface mirrors to the viewer, from the cosines between normal, light and
/// viewer.
float phongSpecular(float normal_light, float normal_viewer, float light_viewer, float shininess);

}  // namespace umbrick
