// The unbiased integrator.
#pragma once
#include "reference/quadrature.h"
#include "umbrick/core/random.h"

namespace umbrick {

/// One per thread.
class MonteCarloPixel {
 public:
  MonteCarloPixel(const ReferenceSpace& space, const ReferenceOptions& options)
      : space_(space), options_(options), accessor_(space.field.accessor()) {}

  PixelResult integrate(int x, int y);
  const RayCounts& counts() const { return counts_; }

 private:
  struct Collision {
    bool happened = false;
    double t = 0;
    Medium medium;
  };

  template <class Visit>
  void trackBlocks(const IndexRay& ray, const Interval& part, Random& random, const Visit& visit);
  Collision collide(const IndexRay& ray, const Interval& part, Random& random);
  double estimateVisibility(const glm::dvec3& point, const glm::dvec3& towardsEye, Random& random);

  const ReferenceSpace& space_;
  ReferenceOptions options_;
  Field::Accessor accessor_;
  RayCounts counts_;
};

}  // namespace umbrick
