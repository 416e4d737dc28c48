// The polygon in which a plane cuts a parallelepiped, by the signs of its corners.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace umbrick {

/// Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e joins corners kEdgeCorners[e][0] and [1]; the
/// first is the lower one along the edge's axis, so that all cells around an edge name its ends in the same order.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> kEdgeCorners{{
    {0, 1},
    {2, 3},
    {4, 5},
    {6, 7},  // along x
    {0, 2},
    {1, 3},
    {4, 6},
    {5, 7},  // along y
    {0, 4},
    {1, 5},
    {2, 6},
    {3, 7},  // along z
}};

/// Edges that the plane crosses, in order around the polygon.
struct PlaneCut {
  std::uint8_t count = 0;
  std::array<std::uint8_t, 6> edges{};
};

/// Indexed by a mask with bit c set when corner c is on the far side. Masks that no plane can make stay empty.
std::array<PlaneCut, 256> planeCuts();

}  // namespace umbrick
