// The lights that Phong's model reflects.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "umbrick/scene/resolve.h"

namespace umbrick {

/// A light from one direction of the world.
struct ShadingLightRay {
  glm::dvec3 towards{0};  // the light, a unit vector
  glm::dvec3 radiance{1};
};

/// Returns the lights of a shaded scene; none: a headlight of radiance 1, which shines along each ray. Of the scene's
/// sources, cones count as a light from their axis, whatever their angle, and listed directions as they are;
/// environment maps do not count.
/// @throw InvalidArgument  sources are asked for, and none of them is directional
std::vector<ShadingLightRay> shadingLights(const ResolvedScene& scene);

}  // namespace umbrick
