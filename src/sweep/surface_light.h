// The light that reaches the surfaces of a scene, at the voxels around them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "sweep/brick_light.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

class SurfaceLight {
 public:
  /// @param volume  outlives this
  explicit SurfaceLight(const Bricks& volume);

  /// Computes the light of a picture, where it is not there yet, and stores it with the bricks of the surfaces.
  /// @param stats  gets what light took
  /// @throw InvalidArgument  as BrickLight::update
  void update(const ResolvedScene& scene, const RenderSample& sample, BrickVoxels& voxels, RenderStats& stats);

  /// Returns what share of the light reaches a surface, by colour; see umbrick/scene/surface_light.h.
  /// @param brick   one that the surface crosses
  /// @param at      point of the surface, voxels from the brick's first owned one
  /// @param normal  on the viewer's side, world
  glm::dvec3 shareAt(const VoxelBrick& brick, const glm::dvec3& at, const glm::dvec3& normal) const;

  /// Returns what arrives where nothing is in the way.
  glm::dvec3 whole() const { return light_.whole(); }

 private:
  const Bricks& volume_;
  glm::dmat3 toIndex_;
  BrickLight light_;
};

}  // namespace umbrick
