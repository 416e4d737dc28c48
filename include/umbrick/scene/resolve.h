// What follows from a scene once its volume is known.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// A scene whose volume is known: the camera is placed, the spacing of slices is in world units, and there is a
/// transfer function. Renderers, reference and checks take nothing else.
struct ResolvedScene : SceneSettings {
  TransferFunction transfer;
  /// What the values of the second grid emit, see emissionFunction(); none: the scene does not emit, see emits().
  std::optional<TransferFunction> emitted;
  bool operator==(const ResolvedScene&) const = default;

 private:
  ResolvedScene(const SceneSettings& settings, TransferFunction function)
      : SceneSettings(settings), transfer(std::move(function)) {}
  friend ResolvedScene resolveScene(const Scene&, const Box&, const glm::dmat4&);
};

/// Returns the view of an orbit. What is automatic is the usual: z up, and usualFront().
OrbitView orbitView(const Orbit& orbit);

/// Returns a 1D function that is scaled by gradient magnitude as SceneSettings::gradientOpacity says: a 2D one, whose
/// sigma_t is exactly that of the 1D function times the ramp. @pre 0 <= ramp.x < ramp.y
TransferFunction withGradientOpacity(const TransferFunction& transfer, const glm::dvec2& ramp);

/// Writes out everything that depends on the volume: an orbit becomes a camera, a spacing in voxels (shortest edge)
/// becomes world units. In modes that show a medium the transfer function becomes one of value and gradient magnitude
/// where the scene has a gradientOpacity.
/// @param worldBounds  of what an orbit looks at, see orbitCamera
/// @throw InvalidArgument  there is no transfer function, an orbit should look at an empty volume, gradientOpacity has
/// a 2D
///   function beside it or is in percent, which Volume::resolve() knows; or as validateScene
ResolvedScene resolveScene(const Scene& scene, const Box& worldBounds, const glm::dmat4& indexToWorld);

/// Returns the scene that resolves to this one, whatever the volume.
Scene unresolved(const ResolvedScene& scene);

/// Checks every field against its range. @throw InvalidArgument  as validateScene(unresolved(scene))
void validateScene(const ResolvedScene& scene);

/// Returns the same as printScene(unresolved(scene)).
std::string printScene(const ResolvedScene& scene);

/// Returns half-spaces that keep the inside of a box, world units.
/// @param toWorld  converts the box's coordinates to the world; affine
std::vector<ClipPlane> boxPlanes(const Box& box, const glm::dmat4& toWorld = glm::dmat4(1));

/// Returns the length of a voxel's shortest edge, world units.
double shortestVoxelEdge(const glm::dmat4& indexToWorld);

/// Returns the box, in index coordinates, that holds the medium. Where the background is visible, the medium ends at
/// the faces of the box; where it is not, nothing lies beyond them anyway. Renderers and reference use the same box.
/// @param domain  active voxels, and others that differ from the background, grown by one voxel: where interpolated
///   values may differ from the background. Gradient magnitudes may differ from 0 one voxel farther out, so the box of
///   a 2D function is larger by that.
IndexBox mediumBox(const TransferFunction& transfer, const IndexBox& domain);

}  // namespace umbrick
