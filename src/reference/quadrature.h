// The deterministic integrator.
#pragma once
#include <optional>
#include <vector>

#include "reference/convex_region.h"
#include "reference/eye_ray.h"
#include "reference/pixel.h"
#include "umbrick/optics/directions.h"
#include "umbrick/reference/reference.h"

namespace umbrick {

/// What both integrators look at.
struct ReferenceSpace {
  const Field& field;
  const Classifier& classifier;
  const EyeRays& rays;
  const ConvexRegion& region;
  const Scene& scene;
};

/// Optical depth along the ray, up to `limit` and a little more.
double opticalDepth(const Field& field, Field::Accessor& accessor, const Classifier& classifier, const IndexRay& ray,
                    const Interval& part, double limit, std::uint64_t& cells);

/// One per thread.
class QuadraturePixel {
 public:
  /// @param step  world units; 0: adaptive
  QuadraturePixel(const ReferenceSpace& space, const ReferenceOptions& options, double step, double voxelEdge,
                  const GoOn& goOn);

  /// Nothing when the job was stopped meanwhile.
  std::optional<PixelResult> integrate(int x, int y);
  const RayCounts& counts() const { return counts_; }

 private:
  struct LightDirection {
    glm::dvec3 index;
    double weight;
  };
  struct Sum {
    glm::dvec3 light{0};
    double visibility = 0;
  };

  void aimLights(const glm::dvec3& axis);
  double visibilityAt(const IndexRay& ray, double t);
  double meanVisibility(const IndexRay& ray, std::size_t begin, std::size_t end);
  Sum weigh(std::size_t begin, std::size_t end, double visibility) const;
  Sum refine(const IndexRay& ray, std::size_t begin, std::size_t end, double visibility, int depth);
  Sum integrateAdaptive(const IndexRay& ray);
  Sum integrateSteps(const IndexRay& ray);

  const ReferenceSpace& space_;
  ReferenceOptions options_;
  GoOn goOn_;
  bool stopped_ = false;
  double step_, voxelEdge_;
  EyeRayOptions eyeOptions_;
  Field::Accessor accessor_;
  std::vector<LightDirection> lights_;
  std::vector<Scatterer> parts_;
  std::vector<Scatterer> before_;  // sums of the parts before each one; t weighted by alpha
  RayCounts counts_;
};

}  // namespace umbrick
