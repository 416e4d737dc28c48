// The directions of the light as the slices of a picture see them, and how far light moves across from slice to slice.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/core/camera.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

/// How paths in one direction cross the slices. The default path runs along the view axis.
struct LightSlope {
  glm::dvec2 slope{0};  // change across per depth on the way to the light, against the view direction
  double stretch = 1;   // length per depth: 1 / cos(angle to the view axis)
};
/// Returns how paths towards the light cross the slices.
/// @param towards  unit length, along (right, up, towards the viewer), the last above 0; less than 1e-6 counts as that,
///   so that numbers of texels stay exact
LightSlope lightSlope(const glm::dvec3& towards);

/// The paths along which transmittance is carried through the slices.
struct LightPaths {
  LightSlope view;                 // the path along the view axis: it brings no light, but tells how much the eye sees
  std::vector<LightSlope> lights;  // one path for each direction of the light
  std::size_t count() const { return lights.size() + 1; }
};

/// The light of a picture, aimed at its slices.
struct AimedLight {
  LightPaths paths;
  std::vector<glm::vec4> radiance;  // for each direction: rgb, and its share of all light
  glm::dvec3 whole{0};              // sum of the radiances, which arrives where nothing is in the way
  bool coloured = false;            // the directions' radiances differ in more than brightness
};
/// Aims the directions at the slices. @param axes  of the camera. @pre every direction lies in the viewer's hemisphere
AimedLight aimLight(std::span<const LightDirection> directions, const CameraFrame& axes);

/// The rounding that stands for one half. Light at 45 degrees has shifts that end in a half on every slice, and slopes
/// are known to 1e-16: halves have to go one way, or slices jump as the camera moves.
inline constexpr double kHalfRounding = 0.5 - 1e-6;

/// Returns what is added to the shift of each direction before it is cut to whole texels.
/// @param rounding  see RenderSample. One half is one half for all directions; any other value is the start of the
///   sequence R2 (Roberts 2018), so that each direction has a rounding of its own and all are spread evenly.
std::vector<glm::dvec2> shiftRoundings(std::size_t directions, const glm::dvec2& rounding);

/// Returns by how many whole texels paths move across between the eye and a slice. @param depth  of the slice, texels
inline glm::dvec2 wholeShift(double depth, const LightSlope& light, const glm::dvec2& rounding) {
  return glm::floor(depth * light.slope + rounding);
}

}  // namespace umbrick
