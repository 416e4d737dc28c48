// The place of a volume in the world, as headers state it: a matrix from indices to world space.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Whether the first three columns are independent directions.
bool spansSpace(const glm::dmat4& indexToWorld);

/// Multiplies the axes of the world by `factors`: a change of its units.
void scaleWorld(glm::dmat4& indexToWorld, const glm::dvec3& factors);

/// @param field  what messages call the place
/// @throw IoError  info.indexToWorld is not finite or does not span space
void checkPlace(const VolumeInfo& info, const std::string& field);

}  // namespace umbrick
