// Phong's model in shaders, see shaders/shade/phong_lights.glsl.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>

#include "umbrick/gl/program.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// @throw InvalidArgument  as shadingLights
void setPhongConstants(ShaderConstants& constants, const ResolvedScene& scene);
void setPhongUniforms(GlProgram& program, const ResolvedScene& scene, const glm::dmat4& indexToWorld);

}  // namespace umbrick
