// View rays through a medium whose light is found by rays from each of their samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "sweep/brick_table.h"
#include "sweep/medium_table.h"
#include "sweep/value_ray.h"
#include "umbrick/core/box.h"
#include "umbrick/mesh/mesh.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

/// What the rays of a picture share.
struct ConeFrame {
  const BrickVoxels* voxels = nullptr;  // all visible bricks, held
  const BrickTable* bricks = nullptr;
  const MediumTable* table = nullptr;      // of a function of the value alone
  std::vector<LightDirection> directions;  // of the light
  /// Half-spaces in which the medium lies that the eye sees, and that keeps light away, index coordinates; those of the
  /// visible box among them.
  std::vector<glm::dvec4> planes, lightPlanes;
  Box visible;                 // the space of cells in visible bricks, index coordinates
  const Mesh* mesh = nullptr;  // that keeps light away; null: there is none
  double longest = 1;          // segment of a view ray, depth along the view axis, world units
  double saturation = 0;
};

/// Takes view rays through the groups of cells that show something. A segment has the mean medium over a value that
/// runs linearly, and the light of the place where half of what it hides would lie: rays go from there in each
/// direction of the light, in steps of a voxel, and are not stored. So light is neither interpolated nor blurred, which
/// makes these pictures something to compare others with, at the price of a ray for each sample and direction.
/// Each thread has one.
class ConeMarch {
 public:
  explicit ConeMarch(const ConeFrame& frame);

  struct Pixel {
    glm::dvec3 colour{0};                           // premultiplied, for an ambient radiance of 1
    double opacity = 0, visibility = 0, depth = 0;  // the last two weighted by opacity
  };
  /// @param ray    from the eye; its part that counts
  /// @param toEnd  depth at which it ends
  Pixel march(ValueRay ray, double toEnd);
  std::uint64_t segments() const { return segments_; }  // of view rays, so far

 private:
  struct Light {
    glm::dvec3 colour{0};
    double visibility = 0;  // the share of it
  };
  template <class Visit>
  bool eachStretch(const ValueRay& ray, const Visit& visit) const;
  double stepsAt(const PlacedBrick& entry, const glm::dvec3& point) const;
  Light lightAt(const glm::dvec3& point) const;
  double opticalDepth(const ValueRay& ray, double most) const;

  const ConeFrame& frame_;
  glm::dmat3 toWorld_, toIndex_;
  glm::dvec3 whole_{0};
  std::uint64_t segments_ = 0;
};

}  // namespace umbrick
