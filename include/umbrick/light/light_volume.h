// The light that reaches each voxel of the visible bricks, as a sparse volume beside them.
//
// A light volume has no slices of the view: what draws a picture reads the light with one more trilinear fetch.
// Directions are sorted by the axis and the sign of their largest component in index space into up to six sweeps. A
// sweep goes through the voxels slice by slice along its axis. Every direction carries the optical depths of its paths
// in a plane lattice of one path for each voxel:
//
//     light of direction k                 U = X - m slope_k    path U is at X on slice m; slope_k: |components| <= 1
//        \    \    \    \                  D_k(U) += tau        tau: of the path between two slices
//     ----x----x----x----x--- slice m      L(X)   += w_k exp(-D_k)
//          \    \    \    \                                     X lies between four paths, U between four voxels:
//     ------x----x----x----x- slice m+1                         both are interpolated with weights constant on a slice
//
// So a lattice is shifted and never resampled: optical depths do not blur on the way, and empty space changes nothing.
// Only rows of voxels in or next to visible bricks are visited. A mesh ends paths, wherever it meets them. Where light
// is held at every second voxel, paths are two voxels apart, too; they still meet every slice, so that their optical
// depths are as exact.
//
// Compared with Fattal 2009, Participating Media Illumination Using Light Propagation Maps,
// doi:10.1145/1477926.1477933: his maps are 2D sets of rays detached from the grid, too, so that light neither blurs
// nor runs along the axes. They carry radiance of several scattering events, store the place of each ray, and leave
// light in the cells that a ray crosses. Here light is attenuated only (single scattering), the rays of a map are
// parallel, so that no place is stored and all weights on a slice are the same numbers, and a voxel takes the mean of
// the rays around it. The grid is sparse, and optical depth between two slices is exact for values that run linearly.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/optics/transfer_function.h"
#include "umbrick/scene/lights.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// A surface on which the volume has one value. It keeps a share of the light away, and light is held around it as it
/// is around a medium, for one voxel more than it is read at.
struct LightSurface {
  double value = 0;    // grid units
  double opacity = 1;  // in [0, 1]: the share that each crossing takes; of no effect beside a 2D function
  bool operator==(const LightSurface&) const = default;
};

/// All that light depends on besides the voxels.
struct LightMedium {
  TransferFunction transfer;
  std::vector<LightDirection> directions;
  /// The medium lies where dot(xyz, index) + w >= 0 for all of these, index coordinates. Beyond a plane that cuts
  /// through medium there is more light than arrives there, for three voxels: so much that what is read linearly
  /// between there and the first voxel within looks as bright as what falls off from the plane on.
  std::vector<glm::dvec4> planes;
  std::vector<glm::ivec3> cells;  // first owned voxels of the bricks in which something is visible
  /// Light is held at every voxel (1) or at every second one along each axis (2), which takes a sixth of the memory and
  /// half the time. 0: at every voxel, unless there is no memory for that.
  int spacing = 0;
  std::vector<LightSurface> surfaces = {};
  /// What the second grid emits, as a function of its values (emissionFunction): it lights the medium, too, scattered
  /// once and alike in all directions. It is computed in cells, see LightStats::glowCell. None: nothing emits.
  std::optional<TransferFunction> emitted = {};
  /// Keeps all light from what lies behind it, also from outside of the bricks. Another one is another medium, even
  /// with the same triangles.
  std::shared_ptr<const Mesh> mesh = {};
  bool operator==(const LightMedium&) const = default;
};

/// Returns what the light at a scene's surfaces depends on, but for the planes that cut the medium: the bricks that the
/// transfer function shows, and those that a surface crosses.
/// @throw InvalidArgument  as backgroundBricks
LightMedium lightAtSurfaces(const Bricks& volume, const ResolvedScene& scene, std::vector<LightDirection> directions);
/// Returns what the light in a scene's medium depends on, but for the planes that cut it. Where what the scene emits
/// lights the medium, the lights are multiplied by L_a, so that all is in one unit: see lightScale().
/// @param cells  first owned voxels of the bricks in which something is visible
LightMedium lightInMedium(const ResolvedScene& scene, std::vector<LightDirection> directions,
                          std::vector<glm::ivec3> cells);
/// Tells whether a function shows the background of a volume, whose medium ends at the faces of mediumBox() then.
bool showsBackground(const TransferFunction& transfer, const Bricks& volume);

/// Tells whether a plane leaves anything out of bricks that are grown by a voxel, so that it is one of a medium's.
/// @param cells  first owned voxels; interior: owned voxels along each axis
bool cutsMedium(const glm::dvec4& plane, std::span<const glm::ivec3> cells, const glm::ivec3& interior);

struct LightStats {
  int directions = 0, sweeps = 0;
  std::uint64_t updates = 0;    // path texels that were taken through a slice
  std::uint64_t bytes = 0;      // of host memory, while light is computed
  std::uint64_t heldBytes = 0;  // of host memory, from then on
  int spacing = 1;              // of the places of light, voxels
  double spacingError = 0;      // of light at every second voxel, root mean square, a share of whole(); an estimate
  int glowCell = 0;             // edge of the cells in which what emits lights the medium, voxels; 0: nothing does
  bool edited = false;          // no more was swept than what an edit touches
  double ms = 0;
};

/// Holds the light of one medium.
class LightVolume {
 public:
  /// @param volume  outlives this
  explicit LightVolume(const Bricks& volume);
  ~LightVolume();

  /// Computes the light where anything has changed since the last call. Where an edit changes the medium of some bricks
  /// (the transfer function between its ends, a clip plane, more bricks) or some directions, only the paths through
  /// these bricks, or these directions, are swept, if that is less work. The light then is off by at most half a step
  /// of 1/65535 more than that of a fresh sweep; after a few edits all is swept again.
  /// @return whether it was computed
  /// @param mostBytes  of host memory
  /// @throw InvalidArgument  more memory would be needed: the message says how much
  bool update(const LightMedium& medium, std::uint64_t mostBytes);

  /// Tells whether the directions' radiances differ in more than brightness, or something emits, so that there are
  /// three channels.
  bool coloured() const;
  int channels() const { return coloured() ? 3 : 1; }
  /// Returns what arrives where nothing is in the way: the sum of the radiances, and the most of what is emitted.
  glm::dvec3 whole() const;
  const LightStats& stats() const;

  /// Reads the light of the brick at `origin` with its apron, edge() voxels along each axis, x fastest, as shares of
  /// whole(), in steps of 1/65535 or, where planes cut the medium, of that part of the most. It is 0 at voxels without
  /// medium next to them, where nobody reads it, and at least a step at all others.
  /// @param light  channels() numbers a voxel
  /// @throw InvalidArgument  not one of the cells, or a span of the wrong size
  void read(const glm::ivec3& origin, std::span<float> light) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
