// The picture of a lattice of rays, seen through the pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "sweep/ray_lattice.h"

namespace umbrick {

/// What the rays of a lattice have gathered.
struct LatticePicture {
  RayLattice lattice;
  int stride = 0;                    // rays from row to row
  std::vector<glm::vec4> colour;     // premultiplied
  std::vector<glm::vec2> aux;        // opacity times light, and times depth; empty: is not asked for
  std::vector<std::uint8_t> filled;  // by row: whether anything was met
};

struct WarpedPixel {
  glm::vec4 colour{0};
  glm::vec2 aux{0};
};

/// Fills a row of pixels. Between 4 x 4 rays colour is interpolated by the cubic convolution of Keys 1981
/// (doi:10.1109/TASSP.1981.1163711; a = -1/2), which is exact for quadratic functions; what overshoots is cut off at
/// the extremes of the nearest 2 x 2 rays. Beyond the lattice there is nothing.
/// @param onlyMain  leave pixels alone whose rays run along another axis more than along the lattice's
void warpRow(const LatticePicture& picture, const IndexView& view, int y, bool onlyMain, std::span<WarpedPixel> pixels);

}  // namespace umbrick
