// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "shade/view_planes.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {
// Halves of a segment are exact up to here.
constexpr double kMostOnARay = 1 << 22;
}  // namespace

CellBox cellsAround(std::span<const glm::ivec3> origins, const glm::ivec3& interior, const glm::ivec3& parts) {
  glm::i64vec3 low(origins.front()), high(low);
  for (const glm::ivec3& origin : origins) {
    low = glm::min(low, glm::i64vec3(origin));
    high = glm::max(high, glm::i64vec3(origin));
  }
  return {low, ((high - low) / glm::i64vec3(interior) + std::int64_t{1}) * glm::i64vec3(parts)};
}

RayFrame::RayFrame(const IndexView& view, const CellBox& box, const glm::ivec3& edge, double spacing, int segments,
                   double phase)
    : bricks(box), interior(edge), depth(spacing / segments) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  const glm::dvec3 extent = glm::dvec3(box.count) * glm::dvec3(edge);
  for (unsigned c = 0; c < 8; ++c) {
    const glm::dvec3 corner =
        glm::dvec3(box.first) - 0.5 + extent * glm::dvec3(c & 1 ? 1 : 0, c & 2 ? 1 : 0, c & 4 ? 1 : 0);
    const double s = view.toView(corner).z;
    nearest = std::min(nearest, s);
    farthest = std::max(farthest, s);
  }
  const double shift = 0.5 * depth + (phase - 0.5) * spacing;
  const double first = std::floor((std::max(nearest, 0.0) - shift) / depth) - 1;
  const double last = std::ceil((farthest - shift) / depth) + 1;
  firstDepth = first * depth + shift;
  if (!(farthest > 0)) return;  // all is behind the eye
  if (!(last - first < kMostOnARay))
    throw InvalidArgument("sampling.spacing: " + std::to_string(spacing) + " makes more than " +
                          std::to_string(static_cast<int>(kMostOnARay)) + " segments of a ray");
  count = static_cast<std::int64_t>(last - first) + 1;
}

void RayFrame::setUniforms(GlProgram& program, const IndexView& view, std::span<const glm::dvec4> planes,
                           const Box& medium) const {
  const glm::dvec2 pixel = 2.0 * view.halfExtent / glm::dvec2(view.size);
  program.set("screen_scale", glm::vec2(pixel));
  program.set("screen_offset", glm::vec2(view.centre - view.halfExtent));
  // The eye may be far from the volume: what is counted in single precision begins at the volume.
  const glm::dvec3 corner = glm::dvec3(bricks.first) - 0.5;
  program.set("first_middle", glm::vec3((view.eyeIndex - corner) + firstDepth * view.toIndex[2]));
  program.set("first_depth", static_cast<float>(firstDepth));
  program.set("segment_depth", static_cast<float>(depth));
  program.set("across_x", glm::vec3(view.toIndex[0]));
  program.set("across_y", glm::vec3(view.toIndex[1]));
  program.set("forward", glm::vec3(view.toIndex[2]));
  program.set("segment_count", static_cast<float>(count));
  program.set("brick", glm::vec3(interior));
  program.set("medium_low", glm::vec3(medium.min - corner));
  program.set("medium_high", glm::vec3(medium.max - corner));
  std::vector<glm::vec4> inShader;
  for (const glm::dvec4& plane : planes) {
    const glm::dvec4 inIndex = planeInIndex(plane, view);
    inShader.emplace_back(glm::dvec3(inIndex), inIndex.w + glm::dot(glm::dvec3(inIndex), corner));
  }
  program.set("clip_planes", inShader);
}

}  // namespace umbrick
