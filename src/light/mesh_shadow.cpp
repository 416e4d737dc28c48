// SPDX-License-Identifier: Apache-2.0
#include "light/mesh_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "light/sweep_kernels.h"

namespace umbrick {
namespace {

// Paths that lie so near to an edge, in places, are covered by both triangles, so that none slips through between two.
constexpr double kEdgeWidth = 1e-9;
constexpr float kNowhere = std::numeric_limits<float>::infinity();
// Of a path that has ended: kDarkDepth and what else there is to be seen as 0.
constexpr float kEnded = 2 * kDarkDepth;

// The integers between two numbers that lie in [from, to), as a half-open range.
Span within(double low, double high, int from, int to) {
  const double begin = std::clamp(std::ceil(low - kEdgeWidth), double(from), double(to));
  const double end = std::clamp(std::floor(high + kEdgeWidth) + 1, double(from), double(to));
  return {static_cast<int>(begin), static_cast<int>(end)};
}

}  // namespace

IndexTriangles trianglesInIndex(const Mesh& mesh, const glm::dmat4& indexToWorld) {
  const glm::dmat4 toIndex = glm::inverse(indexToWorld);
  IndexTriangles triangles{mesh.vertices(), mesh.corners()};
  for (glm::dvec3& vertex : triangles.vertices) vertex = glm::dvec3(toIndex * glm::dvec4(vertex, 1));
  return triangles;
}

MeshShadow::MeshShadow(const IndexTriangles& mesh, const SweptDirection& direction, const PlaneWindow& paths,
                       int spacing)
    : sign_(direction.sign), spacing_(spacing) {
  const SweepAxes axes = kSweepAxes[direction.axis];
  // Number of the path along u and v, see pathPlace(), and slices on the way of the light.
  std::vector<glm::dvec3> placed;
  placed.reserve(mesh.vertices.size());
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& vertex : mesh.vertices) {
    const double way = -direction.sign * vertex[axes.n];
    placed.emplace_back((vertex[axes.u] - way * direction.u) / spacing, (vertex[axes.v] - way * direction.v) / spacing,
                        way);
    low = glm::min(low, placed.back());
    high = glm::max(high, placed.back());
  }
  const Span u = within(low.x, high.x, paths.u0, paths.u1), v = within(low.y, high.y, paths.v0, paths.v1);
  window_ = {u.begin, u.end, v.begin, v.end};
  if (window_.empty()) return;
  first_.assign(static_cast<std::size_t>(u.end - u.begin) * static_cast<std::size_t>(v.end - v.begin), kNowhere);
  for (const glm::uvec3& corner : mesh.corners) cover(placed[corner.x], placed[corner.y], placed[corner.z]);
}

// Takes the paths that a triangle covers.
void MeshShadow::cover(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const Span rows = within(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), window_.v0, window_.v1);
  if (rows.begin >= rows.end) return;
  const Span columns = within(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), window_.u0, window_.u1);
  if (columns.begin >= columns.end) return;
  const std::array<const glm::dvec3*, 4> ring{&a, &b, &c, &a};
  for (int v = rows.begin; v < rows.end; ++v) {
    // Where the row enters the triangle and leaves it: column and way.
    glm::dvec2 enter(std::numeric_limits<double>::infinity(), 0), leave(-enter.x, 0);
    const auto take = [&](const glm::dvec2& at) {
      if (at.x < enter.x || (at.x == enter.x && at.y < enter.y)) enter = at;
      if (at.x > leave.x || (at.x == leave.x && at.y < leave.y)) leave = at;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &from = *ring[i], &to = *ring[i + 1];
      if (std::min(from.y, to.y) > v + kEdgeWidth || std::max(from.y, to.y) < v - kEdgeWidth) continue;
      if (std::abs(to.y - from.y) <= kEdgeWidth) {
        take({from.x, from.z});
        take({to.x, to.z});
        continue;
      }
      const double share = std::clamp((v - from.y) / (to.y - from.y), 0.0, 1.0);
      take({glm::mix(from.x, to.x, share), glm::mix(from.z, to.z, share)});
    }
    if (!(enter.x <= leave.x)) continue;
    const Span part = within(enter.x, leave.x, columns.begin, columns.end);
    const double per = leave.x - enter.x > kEdgeWidth ? 1 / (leave.x - enter.x) : 0;
    float* const ways = first_.data() + rowAt(v);
    for (int u = part.begin; u < part.end; ++u) {
      float& way = ways[u - window_.u0];
      const double share = std::clamp((u - enter.x) * per, 0.0, 1.0);
      way = std::min(way, static_cast<float>(glm::mix(enter.y, leave.y, share)));
    }
  }
}

void MeshShadow::darken(int u, int v, int n, bool lit, float* depth, int count) const {
  if (v < window_.v0 || v >= window_.v1) return;
  const int begin = std::max(window_.u0 - u, 0), end = std::min(window_.u1 - u, count);
  if (begin >= end) return;
  const float* const ways = first_.data() + rowAt(v) + (u - window_.u0);
  const float here = static_cast<float>(-sign_ * n), half = 0.5f * static_cast<float>(spacing_);
  for (int i = begin; i < end; ++i) {
    const float ahead = ways[i] - here;
    if (ahead >= half) continue;
    if (ahead <= -half)
      depth[i] = std::max(depth[i], kEnded);
    else if (lit)
      depth[i] -= std::max(std::log(0.5f + 0.5f * ahead / half), -kEnded);
  }
}

}  // namespace umbrick
