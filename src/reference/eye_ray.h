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

/// Rays through pixels, in index space; t is the distance from the origin of a ray in world units. Rays
/// begin at the eye, or on its plane in an orthographic view.
class EyeRays {
 public:
  EyeRays(const Camera& camera, const glm::dmat4& indexToWorld);

  struct Ray {
    IndexRay index;
    glm::dvec3 direction;       // world space, unit length
    double depthPerLength = 1;  // depth along the view axis for each unit of t
  };
  /// @param place  in the pixel, in [0, 1]^2; 1/2: its centre
  Ray through(int x, int y, const glm::dvec2& place) const;
  /// Turns a direction of world space, of unit length, into a direction of index space.
  glm::dvec3 toIndex(const glm::dvec3& direction) const { return linear_ * direction; }

 private:
  Camera camera_;
  CameraFrame frame_;
  ScreenPlane plane_;
  glm::dmat4 worldToIndex_;
  glm::dmat3 linear_;
};

/// A short part of a ray, and how much of what it scatters reaches the eye.
struct Scatterer {
  double t = 0;              // centre of the scattering
  double alpha = 0;          // T(begin) - T(end), where T is the transmittance from the eye
  glm::dvec3 light{0};       // Int T sigma_s ds
  std::int64_t stretch = 0;  // number of the step of given length in which the part lies
};

/// What the ray gathers beside what scatters.
struct Emitted {
  const Classifier& function;  // of the values of a second grid; sigma_s is what is emitted
  glm::dvec3 light{0};         // Int T L_e ds
};

struct EyeRayOptions {
  double largestTau = 0.1;      // largest optical depth of one part
  double step = 0;              // world units: parts end at multiples of it from the beginning of the ray; 0: anywhere
  double darkest = 1e-7;        // transmittance at which the ray ends
  bool classifyVoxels = false;  // media are interpolated and not values
};

/// Collects the parts of a ray that scatter.
/// @param parts    the parts are appended to it, in order
/// @param emitted  null: nothing emits
/// @return the opacity of the ray; 1 once less than `darkest` gets through
double collectScatterers(const Field& field, Field::Accessor& accessor, const Classifier& classifier,
                         const IndexRay& ray, const Interval& part, const EyeRayOptions& options,
                         std::vector<Scatterer>& parts, std::uint64_t& cells, Emitted* emitted = nullptr);

}  // namespace umbrick
