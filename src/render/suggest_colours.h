// Colours of suggested transfer functions, as linear albedo. All are light, since occlusion darkens them and shape has
// to stay readable, and lightness rises with the value.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>

namespace umbrick {

/// Blue over green to pale yellow, in equal steps of lightness. @param share  in [0, 1]
glm::dvec3 ascendingColour(double share);
/// The colour of things of one material: that of pale clay, on which shape reads well.
glm::dvec3 plainColour();
/// Blue (-1) over white (0) to red (1); both ends are equally light. @param share  in [-1, 1]
glm::dvec3 divergingColour(double share);
/// Dark red over orange to pale yellow, as glowing bodies. @param share  in [0, 1]
glm::dvec3 glowingColour(double share);
/// Colours that differ from each other: first those of Okabe and Ito 2008 that are not grey, which people with any kind
/// of colour vision tell apart, then hues that are the golden angle apart.
glm::dvec3 labelColour(std::size_t label);

}  // namespace umbrick
