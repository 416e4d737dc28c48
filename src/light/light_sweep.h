// Takes the light of some directions through the bricks along one axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <mutex>
#include <vector>

#include "light/cell_store.h"
#include "light/extinction_table.h"

namespace umbrick {

/// A direction in index space as a sweep sees it.
struct SweptDirection {
  int axis = 2;                   // along which the direction's largest component is
  int sign = 1;                   // of that component: light comes from there
  double u = 0, v = 0;            // how a path moves across from slice to slice, away from the light
  double length = 1;              // of the path between two slices, world units
  std::array<float, 3> weight{};  // by channel: share of the whole light
};

/// Light is summed in whole numbers, so that the order of sums does not matter. This is the number of light 1.
inline constexpr float kWholeLight = 1 << 22;

/// The voxels of all bricks as sweeps along one axis read and light them. Those of a brick and its
/// apron are in the order of (u, v, n).
struct SweptBricks {
  SweepLattice lattice;
  const std::vector<LitBlocks>* lit = nullptr;  // by brick
  const float* values = nullptr;                // brick by brick, in steps of the table
  std::int32_t* light = nullptr;                // brick by brick, channel by channel
  int channels = 1;
  const ExtinctionTable* extinction = nullptr;
  std::vector<glm::dvec4> planes;  // in (u, v, n, 1)
  std::vector<std::mutex> busy;    // one for each slice that is lit
};

/// Adds the light of directions of one axis and one sign. Several threads may call this for the same bricks.
/// @return how many texels of paths were taken through a slice
std::uint64_t sweepLight(SweptBricks& bricks, const std::vector<SweptDirection>& directions);

}  // namespace umbrick
