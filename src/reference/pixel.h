// What an integrator finds out about one pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace umbrick {

struct PixelResult {
  glm::dvec3 light{0};     // Int T sigma_s V ds, which the caller multiplies by L_a
  glm::dvec3 emitted{0};   // Int T L_e ds, of a second grid; and all light of the medium where that lights it
  double opacity = 0;      // of the whole ray
  double visibility = 0;   // weighted by opacity
  double depth = 0;        // depth along the view axis, weighted by opacity
  glm::dvec4 variance{0};  // of the means of light, or of `emitted` where it is not 0, (x, y, z) and opacity (w)
  bool converged = true;   // false: the standard error that was asked for was not reached

  /// Adds the result of one ray out of several, which all count for the same `weight`.
  void add(const PixelResult& ray, double weight) {
    light += weight * ray.light;
    emitted += weight * ray.emitted;
    opacity += weight * ray.opacity;
    visibility += weight * ray.visibility;
    depth += weight * ray.depth;
  }
};

/// A function that is asked now and then during a long pixel. It returns false when the job is to stop.
using GoOn = std::function<bool()>;

struct RayCounts {
  std::uint64_t eyeRays = 0, lightRays = 0, cells = 0, samples = 0;
  void add(const RayCounts& other) {
    eyeRays += other.eyeRays;
    lightRays += other.lightRays;
    cells += other.cells;
    samples += other.samples;
  }
};

}  // namespace umbrick
