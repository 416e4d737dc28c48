// The deterministic integrator.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "reference/convex_region.h"
#include "reference/eye_ray.h"
#include "reference/mesh_ends.h"
#include "reference/pixel.h"
#include "reference/shaded_voxels.h"
#include "umbrick/optics/directions.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/light_set.h"

namespace umbrick {

/// The medium, the rays and the light, which both integrators share.
struct ReferenceSpace {
  const Field& field;
  const Classifier& classifier;
  const EyeRays& rays;
  const ConvexRegion& region;
  const ResolvedScene& scene;
  const LightSet* lights;                         // of cone and lights
  const std::vector<LightDirection>& directions;  // of all models but emission and coneRay
  const std::vector<glm::dvec2>& places;          // in each pixel, through which rays go; at least one
  const ScalarGrid& grid;
  const MeshEnds* mesh;        // null: there is none
  const Classifier* emission;  // of a second grid that emits; null: there is none
};

/// Returns light that is the same from all of the solid angle for which the directions stand.
std::vector<LightDirection> evenLight(const std::vector<WeightedDirection>& directions);

/// Returns the optical depth along the ray, but stops counting a little beyond `limit`.
double opticalDepth(const Field& field, Field::Accessor& accessor, const Classifier& classifier, const IndexRay& ray,
                    const Interval& part, double limit, std::uint64_t& cells);

/// Integrates pixels by quadrature. Each thread has an integrator of its own.
class QuadraturePixel {
 public:
  /// @param step  world units; 0: adaptive
  QuadraturePixel(const ReferenceSpace& space, const ReferenceOptions& options, double step, double voxelEdge,
                  const GoOn& goOn);

  /// Integrates one pixel. Returns nothing when the job was stopped meanwhile.
  std::optional<PixelResult> integrate(int x, int y);
  /// Integrates one ray. @param seen  part of it on which the medium is seen
  std::optional<PixelResult> integrate(const EyeRays::Ray& ray, const Interval& seen);

  /// The light that arrives at a point: its share by colour, and that of the power of all lights.
  struct Share {
    glm::dvec3 colour{1};
    double visibility = 1;
  };
  /// @param ray      of the eye, through the point; point: in index coordinates
  /// @param through  returns the share of light that gets through surfaces along a ray from the point
  /// @return none when the job was stopped meanwhile
  std::optional<Share> shareAt(const EyeRays::Ray& ray, const glm::dvec3& point,
                               const std::function<double(const IndexRay&)>& through);
  /// Returns what arrives where nothing is in the way.
  const glm::dvec3& whole() const { return whole_; }
  const RayCounts& counts() const { return counts_; }

 private:
  struct AimedLight {
    glm::dvec3 index;  // direction in index space
    glm::dvec3 radiance;
    double share;  // share of the power of all lights
  };
  /// The light that arrives at a point, by colour, and its share V of the power of all lights.
  struct Arriving {
    glm::dvec3 light{0};
    double visibility = 0;
  };
  struct Sum {
    glm::dvec3 light{0};     // scattered light that reaches the eye
    glm::dvec3 arriving{0};  // arriving light, weighted by opacity
    double visibility = 0;
    Sum operator+(const Sum& other) const {
      return {light + other.light, arriving + other.arriving, visibility + other.visibility};
    }
  };

  void aim(const std::vector<LightDirection>& lights);
  void aimAlong(const EyeRays::Ray& ray);
  glm::dvec3 glowAt(const glm::dvec3& point);
  Arriving arrivingAt(const glm::dvec3& point, const std::function<double(const IndexRay&)>& through = {});
  void shade(const IndexRay& ray, PixelResult& result);
  glm::dvec3 shareOf(const glm::dvec3& light) const;
  Arriving meanArriving(const IndexRay& ray, std::size_t begin, std::size_t end);
  Sum weigh(std::size_t begin, std::size_t end, const Arriving& arriving) const;
  Sum refine(const IndexRay& ray, std::size_t begin, std::size_t end, const Arriving& arriving, int depth);
  Sum integrateAdaptive(const IndexRay& ray);
  Sum integrateSteps(const IndexRay& ray);

  const ReferenceSpace& space_;
  ReferenceOptions options_;
  GoOn goOn_;
  bool stopped_ = false;
  std::uint64_t askedAt_ = 0;  // cells that were met when goOn was asked last
  double step_, voxelEdge_;
  EyeRayOptions eyeOptions_;
  Field::Accessor accessor_;
  std::vector<AimedLight> lights_;
  std::vector<AimedLight> glow_;         // where light that is emitted comes from: radiance is a share of 1
  std::vector<Scatterer> onTheWay_;      // of that light
  std::optional<ShadedVoxels> shading_;  // of a medium that reflects light
  glm::dvec3 whole_{1};                  // sum of their radiances
  double brightest_ = 1;                 // largest component of it
  std::vector<Scatterer> parts_;
  std::vector<Scatterer> before_;  // sums over all parts before each one; t is weighted by alpha
  RayCounts counts_;
};

}  // namespace umbrick
