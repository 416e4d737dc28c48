// Soft blobs in a small box, and cameras that look at them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <vector>

#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/image/image.h"

namespace umbrick {

/// Returns the largest of cones that fall from 1 at a centre (xyz) to 0 at a distance (w), and 0 beyond them.
inline double coneAt(const glm::ivec3& i, std::initializer_list<glm::dvec4> cones) {
  double value = 0;
  for (const glm::dvec4& cone : cones)
    value = std::max(value, 1 - glm::length(glm::dvec3(i) - glm::dvec3(cone)) / cone.w);
  return value;
}

/// Soft blobs in a box of 24 voxels, nothing at its faces.
inline double smallBlobs(const glm::ivec3& i) { return coneAt(i, {{9, 8, 15, 7}, {15, 14, 9, 6}, {13, 6, 11, 4}}); }
inline ScalarGrid blobGrid(const glm::ivec3& origin = glm::ivec3(0)) {
  return makeFilled(glm::ivec3(24), origin, smallBlobs);
}
inline constexpr glm::dvec3 kSmallCentre(12, 11, 12);
/// Returns a parallel and a perspective camera that look at the box.
inline std::vector<Camera> smallCameras(int size = 32) {
  return {orthographicCamera({30, 22, 40}, kSmallCentre, 30, size),
          perspectiveCamera({30, 22, 40}, kSmallCentre, 0.6, size)};
}

inline double largestAlpha(const Image& image) {
  float largest = 0;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) largest = std::max(largest, image.pixels[i]);
  return largest;
}

}  // namespace umbrick
