// SPDX-License-Identifier: Apache-2.0
#include "slice/plane_cut.h"

namespace umbrick {
namespace {

// The corners of each face, in order around it.
constexpr std::array<std::array<std::uint8_t, 4>, 6> kFaceCorners{
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

int edgeBetween(int a, int b) {
  for (int e = 0; e < 12; ++e) {
    const auto [first, second] = kEdgeCorners[static_cast<std::size_t>(e)];
    if ((first == a && second == b) || (first == b && second == a)) return e;
  }
  return -1;
}

// A cut runs across each face that it meets, from one crossed edge to the other. So a walk from face to face goes once
// around the polygon.
PlaneCut trace(unsigned mask) {
  std::array<std::array<int, 2>, 12> next;  // per edge: the crossed edges, two at most, that share a face with it
  next.fill({-1, -1});
  int start = -1;
  for (const auto& face : kFaceCorners) {
    int crossed[4], count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const int a = face[i], b = face[(i + 1) % 4];
      if ((mask >> a & 1u) != (mask >> b & 1u)) crossed[count++] = edgeBetween(a, b);
    }
    if (count == 0) continue;
    if (count != 2) return {};  // opposite corners of a face are cut off, which no plane can do
    for (int i = 0; i < 2; ++i) {
      auto& links = next[static_cast<std::size_t>(crossed[i])];
      links[links[0] < 0 ? 0 : 1] = crossed[1 - i];
    }
    start = crossed[0];
  }
  PlaneCut cut;
  for (int edge = start, previous = -1; edge >= 0;) {
    if (cut.count == 6) return {};
    cut.edges[cut.count++] = static_cast<std::uint8_t>(edge);
    const auto& links = next[static_cast<std::size_t>(edge)];
    const int following = links[0] != previous ? links[0] : links[1];
    previous = edge;
    edge = following == start ? -1 : following;
  }
  return cut;
}

}  // namespace

std::array<PlaneCut, 256> planeCuts() {
  std::array<PlaneCut, 256> cuts;
  for (unsigned mask = 0; mask < 256; ++mask) cuts[mask] = trace(mask);
  return cuts;
}

}  // namespace umbrick
