// The polygon in which a plane cuts a parallelepiped, by the signs of its corners.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace umbrick {

/// Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e joins corners kEdgeCorners[e][0] and [1], the
/// lower one along the edge's axis first, so that all cells around an edge name its ends in the same order.
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

/// The edges that the plane crosses, in order around the polygon.
struct PlaneCut {
  std::uint8_t count = 0;
  std::array<std::uint8_t, 6> edges{};
};

/// Returns all cuts. The index is a mask whose bit c is set when corner c is on the far side; masks that no plane can
/// make have empty cuts.
std::array<PlaneCut, 256> planeCuts();

}  // namespace umbrick
