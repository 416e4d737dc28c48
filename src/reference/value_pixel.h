// Pixels of modes that show values: projections and isosurfaces, in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <vector>

#include "reference/classifier.h"
#include "reference/convex_region.h"
#include "reference/eye_ray.h"
#include "reference/field.h"
#include "reference/mesh_ends.h"
#include "reference/phong_model.h"
#include "reference/pixel.h"
#include "reference/quadrature.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/reference/reference.h"

namespace umbrick {

/// What is found out about a pixel, the mean over its samples.
struct ValueResult {
  glm::dvec4 colour{0};   // premultiplied, without a background
  double depth = 0;       // weighted by opacity
  double visibility = 0;  // share of the light that arrives, weighted by opacity
  /// Of projections the number itself; of surfaces that of the nearest one and where it is. NaN: there is none.
  double value = 0;
  glm::dvec3 position{0}, normal{0};
  std::optional<double> first = {};  // of hybrid: where on its ray the first surface is; none: nowhere
};

/// Lays what a ray shows of the volume over a mesh.
void layOverMesh(const MeshEnd& end, const EyeRays::Ray& ray, const glm::dvec3& ambient, ValueResult& result);

/// The mean of the samples of a pixel. What only surfaces have is the mean of those that meet one.
class ValueMean {
 public:
  void add(const ValueResult& sample);
  ValueResult result() const;

 private:
  ValueResult sum_;
  double samples_ = 0, numbers_ = 0;
};

/// What the pixels of a picture share. All of it is found in the grid, not in bricks.
class ValueSpace {
 public:
  /// @throw InvalidArgument  surfaces of values that the volume does not have; no light to reflect
  ValueSpace(const ScalarGrid& grid, const ResolvedScene& scene, bool skipEmpty);
  ~ValueSpace();

  const ResolvedScene& scene() const { return scene_; }
  const Field& field() const { return field_; }
  const EyeRays& rays() const { return rays_; }
  const ConvexRegion& region() const { return region_; }
  /// Where light comes through, which may be behind the eye.
  const ConvexRegion& litRegion() const { return litRegion_; }
  double background() const { return background_; }
  /// The matrix that takes directions of the world to index space.
  glm::dmat3 toIndex() const { return glm::inverse(glm::dmat3(indexToWorld_)); }
  glm::dvec3 worldOf(const glm::dvec3& index) const { return glm::dvec3(indexToWorld_ * glm::dvec4(index, 1)); }
  /// Returns the gradient in the world at a point in index coordinates.
  glm::dvec3 gradientAt(const glm::dvec3& point) const;
  glm::dvec3 colourOf(std::size_t surface) const;
  /// Returns what a surface of that colour sends to the viewer. All directions are unit vectors of the world.
  /// @param share  of the light, that arrives; whole: all of it
  glm::dvec3 shaded(const glm::dvec3& colour, const glm::dvec3& normal, const glm::dvec3& viewer,
                    const glm::dvec3& share, const glm::dvec3& whole) const;

 private:
  const ScalarGrid& grid_;
  const ResolvedScene& scene_;
  glm::dmat4 indexToWorld_;
  double background_;
  Classifier classifier_;
  Field field_;
  EyeRays rays_;
  ConvexRegion region_, litRegion_;
  std::optional<PhongModel> phong_;  // none: surfaces are flat
};

/// Renders pixels. Each thread has one of its own.
class ValuePixel {
 public:
  /// @param mesh  null: there is none
  ValuePixel(const ValueSpace& space, const std::vector<glm::dvec2>& places, const MeshEnds* mesh);
  /// @param light  of the medium around surfaces; null: all of them are lit alike
  /// @return none when the job was stopped meanwhile
  std::optional<ValueResult> integrate(int x, int y, QuadraturePixel* light = nullptr);
  /// Returns the surfaces of a ray, or the first one of hybrid. @pre the mode is one of surfaces
  /// @param last  place on the ray, where it ends
  std::optional<ValueResult> meet(const EyeRays::Ray& ray, double last, QuadraturePixel* light);
  const RayCounts& counts() const { return counts_; }

 private:
  ValueResult project(const EyeRays::Ray& ray, double last);
  double throughSurfaces(const IndexRay& ray);

  const ValueSpace& space_;
  const std::vector<glm::dvec2>& places_;
  const MeshEnds* mesh_;
  Field::Accessor accessor_;
  RayCounts counts_;
};

}  // namespace umbrick
