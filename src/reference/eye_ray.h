// The ray of a pixel, and what of the light that leaves it comes from where.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "reference/classifier.h"
#include "reference/field.h"
#include "umbrick/core/camera.h"

namespace umbrick {

/// Rays through the pixels' centres, in index space, t the distance from their origin in world units. They begin at the
/// eye, or on its plane.
class EyeRays {
 public:
  EyeRays(const Camera& camera, const glm::dmat4& indexToWorld);

  struct Ray {
    IndexRay index;
    glm::dvec3 direction;       // world, unit length
    double depthPerLength = 1;  // along the view axis
  };
  Ray through(int x, int y) const;
  /// A direction of the world, unit length, as a direction of index space.
  glm::dvec3 toIndex(const glm::dvec3& direction) const { return linear_ * direction; }

 private:
  Camera camera_;
  CameraFrame frame_;
  ScreenPlane plane_;
  glm::dmat4 worldToIndex_;
  glm::dmat3 linear_;
};

/// A short part of a ray: how much of what it scatters reaches the eye.
struct Scatterer {
  double t = 0;              // centre of the scattering
  double alpha = 0;          // opacity in front of which the ray's transmittance stands: T(begin) - T(end)
  glm::dvec3 light{0};       // Int T sigma_s ds
  std::int64_t stretch = 0;  // which step of a given length it lies in
};

struct EyeRayOptions {
  double largestTau = 0.1;  // optical depth of one part
  double step = 0;          // parts end at multiples of it from the beginning of the ray; 0: anywhere
  double darkest = 1e-7;    // transmittance at which the ray ends
};

/// @param parts  appended to, in order
/// @return the opacity of the ray; 1 once less than `darkest` gets through
double collectScatterers(const Field& field, Field::Accessor& accessor, const Classifier& classifier,
                         const IndexRay& ray, const Interval& part, const EyeRayOptions& options,
                         std::vector<Scatterer>& parts, std::uint64_t& cells);

}  // namespace umbrick
