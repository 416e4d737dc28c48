// Sample positions over the footprint of the occlusion cone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <vector>

namespace umbrick {

/// Returns n x n points in the unit disk: cell centres of a grid over the square, mapped to the disk with equal areas
/// (Shirley and Chiu 1997, A low distortion map between disk and square, doi:10.1080/10867651.1997.10487479). The
/// points are symmetric about the centre, so that their mean is 0.
std::vector<glm::dvec2> diskGrid(int n);

}  // namespace umbrick
