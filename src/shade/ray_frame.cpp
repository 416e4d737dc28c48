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

PixelBox pixelsOf(const IndexView& view, const CellBox& cells, const glm::ivec3& edge, double begin) {
  const PixelBox all{glm::ivec2(0), view.size};
  glm::dvec2 low(1e300), high(-1e300);
  for (unsigned c = 0; c < 8; ++c) {
    const glm::dvec3 corner =
        glm::dvec3(cells.first) + begin +
        glm::dvec3(cells.count) * glm::dvec3(edge) * glm::dvec3(c & 1 ? 1 : 0, c & 2 ? 1 : 0, c & 4 ? 1 : 0);
    glm::dvec3 seen = view.toView(corner);
    if (view.projection == Projection::perspective) {
      if (!(seen.z > 0)) return all;  // the box reaches behind the eye
      seen /= seen.z;
    }
    const glm::dvec2 pixel =
        (glm::dvec2(seen) - view.centre + view.halfExtent) / (2.0 * view.halfExtent) * glm::dvec2(view.size);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  const glm::dvec2 size(view.size);
  return {glm::ivec2(glm::clamp(low - 1.0, glm::dvec2(0), size)),
          glm::ivec2(glm::clamp(high + 2.0, glm::dvec2(0), size))};
}

RayFrame::RayFrame(const IndexView& view, const CellBox& box, const glm::ivec3& edge, double spacing, int segments,
                   double phase, double begin)
    : bricks(box), interior(edge), corner(begin), depth(spacing / segments) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  const glm::dvec3 extent = glm::dvec3(box.count) * glm::dvec3(edge);
  for (unsigned c = 0; c < 8; ++c) {
    const glm::dvec3 place =
        glm::dvec3(box.first) + begin + extent * glm::dvec3(c & 1 ? 1 : 0, c & 2 ? 1 : 0, c & 4 ? 1 : 0);
    const double s = view.toView(place).z;
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
  const glm::dvec3 origin = glm::dvec3(bricks.first) + corner;
  program.set("first_middle", glm::vec3((view.eyeIndex - origin) + firstDepth * view.toIndex[2]));
  program.set("first_depth", static_cast<float>(firstDepth));
  program.set("segment_depth", static_cast<float>(depth));
  program.set("across_x", glm::vec3(view.toIndex[0]));
  program.set("across_y", glm::vec3(view.toIndex[1]));
  program.set("forward", glm::vec3(view.toIndex[2]));
  program.set("segment_count", static_cast<float>(count));
  program.set("brick", glm::vec3(interior));
  program.set("medium_low", glm::vec3(medium.min - origin));
  program.set("medium_high", glm::vec3(medium.max - origin));
  std::vector<glm::vec4> inShader;
  for (const glm::dvec4& plane : planes) {
    const glm::dvec4 inIndex = planeInIndex(plane, view);
    inShader.emplace_back(glm::dvec3(inIndex), inIndex.w + glm::dot(glm::dvec3(inIndex), origin));
  }
  program.set("clip_planes", inShader);
}

void RayFrame::setCells(GlProgram& program, const CellBox& cells, const glm::ivec3& parts) const {
  const glm::ivec3 part = interior / parts;
  program.set("part", glm::vec3(part));
  program.set("first_cell", glm::ivec3((cells.first - bricks.first) / glm::i64vec3(part)));
}

}  // namespace umbrick
