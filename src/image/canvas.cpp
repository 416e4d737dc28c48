// SPDX-License-Identifier: Apache-2.0
#include "image/canvas.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "umbrick/image/text.h"

namespace umbrick {
namespace {

constexpr float kRimOpacity = 0.9f;

// An offset inside the rim, and how much of the ink there counts at this pixel.
struct RimTap {
  int x, y;
  float weight;
};

std::vector<RimTap> rimTaps(double rim) {
  std::vector<RimTap> taps;
  if (!(rim > 0)) return taps;
  const int reach = static_cast<int>(std::ceil(rim + 0.5));
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const double weight = std::clamp(rim + 0.5 - std::hypot(x, y), 0.0, 1.0);
      if (weight > 0) taps.push_back({x, y, static_cast<float>(weight)});
    }
  return taps;
}

}  // namespace

Canvas::Canvas(const glm::ivec2& low, const glm::ivec2& high) : low_(low), ink_(high.x - low.x, high.y - low.y, 4) {}

void Canvas::blend(int x, int y, const glm::dvec3& colour, double coverage) {
  const glm::ivec2 at = glm::ivec2(x, y) - low_;
  if (!(coverage > 0) || at.x < 0 || at.y < 0 || at.x >= ink_.width || at.y >= ink_.height) return;
  float* pixel = ink_.at(at.x, at.y);
  const double kept = 1 - coverage;
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(coverage * colour[c] + kept * pixel[c]);
  pixel[3] = static_cast<float>(coverage + kept * pixel[3]);
}

void Canvas::line(const glm::dvec2& from, const glm::dvec2& to, double thickness, const glm::dvec3& colour) {
  const double radius = 0.5 * thickness;
  const glm::ivec2 low(glm::floor(glm::min(from, to) - radius - 1.0)),
      high(glm::ceil(glm::max(from, to) + radius + 1.0));
  const glm::dvec2 along = to - from;
  const double square = glm::dot(along, along);
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) {
      const glm::dvec2 p = glm::dvec2(x, y) + 0.5 - from;
      const double t = square > 0 ? std::clamp(glm::dot(p, along) / square, 0.0, 1.0) : 0;
      // A pixel is covered by as much as its distance to the edge of the line says, over the width of a pixel.
      blend(x, y, colour, std::clamp(radius + 0.5 - glm::length(p - t * along), 0.0, 1.0));
    }
}

void Canvas::box(const glm::dvec2& low, const glm::dvec2& high, const glm::dvec3& colour, double opacity) {
  const auto overlap = [](double begin, double end, int pixel) {
    return std::clamp(std::min(end, pixel + 1.0) - std::max(begin, static_cast<double>(pixel)), 0.0, 1.0);
  };
  for (int y = static_cast<int>(std::floor(low.y)); y < static_cast<int>(std::ceil(high.y)); ++y)
    for (int x = static_cast<int>(std::floor(low.x)); x < static_cast<int>(std::ceil(high.x)); ++x)
      blend(x, y, colour, opacity * overlap(low.x, high.x, x) * overlap(low.y, high.y, y));
}

void Canvas::text(const glm::dvec2& origin, const std::string& utf8, double em, const glm::dvec3& colour) {
  const TextMask mask = textMask(utf8, em);
  const glm::ivec2 at = glm::ivec2(glm::round(origin)) + glm::ivec2(mask.left, mask.bottom);
  for (int y = 0; y < mask.coverage.height; ++y)
    for (int x = 0; x < mask.coverage.width; ++x) blend(at.x + x, at.y + y, colour, *mask.coverage.at(x, y));
}

void Canvas::over(Image& picture, double rim, const glm::dvec3& colour) const {
  const std::vector<RimTap> taps = rimTaps(rim);
  for (int y = 0; y < ink_.height; ++y)
    for (int x = 0; x < ink_.width; ++x) {
      const glm::ivec2 at = low_ + glm::ivec2(x, y);
      if (at.x < 0 || at.y < 0 || at.x >= picture.width || at.y >= picture.height) continue;
      float near = 0;
      for (const RimTap& tap : taps) {
        const int nx = x + tap.x, ny = y + tap.y;
        if (nx < 0 || ny < 0 || nx >= ink_.width || ny >= ink_.height) continue;
        near = std::max(near, tap.weight * ink_.at(nx, ny)[3]);
      }
      const float* ink = ink_.at(x, y);
      float* pixel = picture.at(at.x, at.y);
      const float rimAlpha = kRimOpacity * near;
      for (int c = 0; c < 4; ++c) {
        const float rimValue = c == 3 ? 1.0f : static_cast<float>(colour[c]);
        const float behind = rimAlpha * rimValue + (1 - rimAlpha) * pixel[c];
        pixel[c] = ink[c] + (1 - ink[3]) * behind;
      }
    }
}

}  // namespace umbrick
