// Phong's model at the voxels of visible bricks, where light volumes keep their light.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "sweep/brick_light.h"
#include "sweep/brick_voxels.h"
#include "umbrick/core/camera.h"
#include "umbrick/scene/shading_lights.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Computes for each voxel what share of the lights a medium sends to the eye,
///   ambient + V sum over lights of radiance (diffuse N.L + specular (R.V)^shininess)
/// with the normal from the scene's kind of gradients, and keeps it with the bricks in 16 bits a voxel and channel. V
/// is the share of the light that reaches the voxel, see umbrick/scene/surface_light.h. Rays interpolate it as they do
/// light. A voxel without a gradient faces the viewer.
class BrickShading {
 public:
  /// Takes the scene of a picture. @param light  null: all of it arrives; else outlives the picture
  /// @return how many channels the shares have
  /// @pre checkShading()
  int begin(const ResolvedScene& scene, const BrickLight* light);
  /// Computes the shares, in the place of the light that is stored with the bricks.
  void update(BrickVoxels& voxels);

  float unit() const { return unit_; }  // what a code of 1 stands for

 private:
  /// What all voxels of a picture share; vectors are of the world.
  struct View {
    glm::mat3 gradientToWorld{1};
    glm::dmat4 indexToWorld{1};
    glm::dvec3 eye{0};
    bool perspective = false;
    glm::vec3 towardsEye{0};  // of a parallel view
  };
  void shade(VoxelBrick& brick, const BrickVoxels& voxels, const View& view) const;
  glm::vec3 reflected(const glm::vec3& normal, const glm::vec3& viewer) const;

  ShadingOptions shading_;
  GradientFilter gradients_ = GradientFilter::central;
  Camera camera_;
  const BrickLight* light_ = nullptr;
  std::vector<ShadingLightRay> lights_;
  int channels_ = 1;
  float unit_ = 1;
};

}  // namespace umbrick
