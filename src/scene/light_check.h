// Checks the ranges of a light source's fields, and whether its light comes from the viewer's side.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/scene_check.h"
#include "umbrick/scene/light_source.h"

namespace umbrick {

/// Returns the first field that is out of its range. @param number  of the source, from 0
std::optional<Complaint> findComplaint(const LightSource& source, std::size_t number);

/// Returns a complaint about a light whose directions leave the viewer's open hemisphere: slices from the eye on have
/// not met what such light passes.
/// @param viewer  towards the viewer, unit length, in the frame of the source
std::optional<Complaint> findBehindViewer(const LightSource& source, std::size_t number, const glm::dvec3& viewer);

}  // namespace umbrick
