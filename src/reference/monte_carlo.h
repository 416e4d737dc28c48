// The unbiased integrator.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "reference/quadrature.h"
#include "umbrick/core/random.h"

namespace umbrick {

/// Integrates pixels by Monte Carlo. Each thread has an integrator of its own.
class MonteCarloPixel {
 public:
  /// @param voxelEdge  shortest edge of a voxel, world units
  MonteCarloPixel(const ReferenceSpace& space, const ReferenceOptions& options, double voxelEdge, const GoOn& goOn)
      : space_(space),
        options_(options),
        goOn_(goOn),
        dense_(20 / voxelEdge),
        densest_(1e4 / voxelEdge),
        glowing_(space.emission ? 0.5 / voxelEdge : 0),
        power_(space.lights ? space.lights->power() : 1),
        towardsEye_(-cameraFrame(space.scene.camera).forward),
        accessor_(space.field.accessor()) {}

  /// Integrates one pixel. Returns nothing when the job was stopped meanwhile.
  std::optional<PixelResult> integrate(int x, int y);
  const RayCounts& counts() const { return counts_; }

 private:
  struct Collision {
    bool happened = false;
    double t = 0;
    Medium medium;
    glm::dvec3 emitted{0};  // an estimate of Int T L_e ds, whether there is a collision or not
  };

  using Found = std::array<double, 6>;  // light (RGB), opacity, visibility, depth

  Found trace(const EyeRays::Ray& ray, const Interval& part, Random& random);
  template <class Visit>
  void trackBlocks(const IndexRay& ray, const Interval& part, Random& random, const Visit& visit);
  double majorantOf(const FieldBlock& block, const glm::ivec3& cell) const;
  glm::dvec3 radianceAt(const FieldBlock& block, const glm::dvec3& local) const;
  Collision collide(const IndexRay& ray, const Interval& part, Random& random);
  LightDirection chooseLight(const glm::dvec3& towardsEye, Random& random) const;
  double estimateTransmittance(const glm::dvec3& point, const glm::dvec3& direction, Random& random);

  const ReferenceSpace& space_;
  ReferenceOptions options_;
  GoOn goOn_;
  double dense_;  // 1/world unit: in blocks with a majorant from here on each cell has its own majorant
  // 1/world unit: extinction beyond this counts as this, since tracking takes as many steps as the majorant is large.
  double densest_;
  // 1/world unit: where something emits there are at least so many tentative collisions, which sample it.
  double glowing_;
  double power_;           // sum over all lights
  glm::dvec3 towardsEye_;  // against the view axis, world space
  Field::Accessor accessor_;
  RayCounts counts_;
};

}  // namespace umbrick
