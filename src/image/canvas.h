// A part of a picture to draw on: lines, boxes and text, smooth at their edges and with a rim around them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "umbrick/image/image.h"

namespace umbrick {

/// Coordinates are pixels of the picture, with the lower left corner of the picture at 0 and pixel centres at halves.
class Canvas {
 public:
  /// @param low,high  corners of the part, whole pixels; what is drawn beyond it is lost
  Canvas(const glm::ivec2& low, const glm::ivec2& high);

  /// Draws a line with round ends. @param colour  linear
  void line(const glm::dvec2& from, const glm::dvec2& to, double thickness, const glm::dvec3& colour);
  /// Fills a box. @param opacity  of the box
  void box(const glm::dvec2& low, const glm::dvec2& high, const glm::dvec3& colour, double opacity = 1);
  /// Draws a line of text. @param origin  where it begins, on its base line; moved to whole pixels, where letters are
  ///   sharp
  void text(const glm::dvec2& origin, const std::string& utf8, double em, const glm::dvec3& colour);

  /// Puts what was drawn over a picture. @param rim  width of the rim around it, pixels; 0: none  @param colour  of the
  /// rim
  void over(Image& picture, double rim = 0, const glm::dvec3& colour = glm::dvec3(0)) const;

 private:
  void blend(int x, int y, const glm::dvec3& colour, double coverage);

  glm::ivec2 low_;
  Image ink_;  // linear premultiplied
};

}  // namespace umbrick
