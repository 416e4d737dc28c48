// What the bricks of a volume must have for a scene.
#pragma once
#include <glm/mat4x4.hpp>

#include "umbrick/scene/scene.h"

namespace umbrick {

/// Apron voxels that slabs of a resolved scene read beyond a brick. @throw InvalidArgument  a spacing of so many voxels
/// that the apron would be wider than a brick
int requiredApron(const Scene& resolved, const glm::dmat4& indexToWorld);

}  // namespace umbrick
