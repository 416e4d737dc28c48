// Where a mesh ends the paths of light.
//
//   light    \    \    \         Paths of one direction are parallel, so that a triangle covers those whose numbers lie
//   in
//     ---------x----x----x---    its projection along the light onto a slice. Of each path the slice is kept at which
//     it
//           ___\____\_  \        meets the mesh first: all behind that is dark. So a shadow is as exact as the lattice
//           of
//     ---------o----o----x---    paths, costs the triangles and not the medium, and begins anywhere, also outside of
//     all
//               .    .    \      bricks.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "light/cell_store.h"
#include "umbrick/light/light_paths.h"
#include "umbrick/mesh/mesh.h"

namespace umbrick {

/// A mesh in index coordinates.
struct IndexTriangles {
  std::vector<glm::dvec3> vertices;
  std::span<const glm::uvec3> corners;  // of the mesh
};
/// @param mesh  outlives what is returned
IndexTriangles trianglesInIndex(const Mesh& mesh, const glm::dmat4& indexToWorld);

/// Which paths of one direction a mesh ends, and where.
class MeshShadow {
 public:
  /// @param paths  those that are asked for, by their numbers
  MeshShadow(const IndexTriangles& mesh, const SweptDirection& direction, const PlaneWindow& paths, int spacing);

  /// Makes the depths of a row of paths dark behind the mesh. Where a slice has light, a path that meets the mesh less
  /// than half way to the slice with light before or behind it gets as much less light as lies behind the mesh of the
  /// space between the middles of the three, so that a slanted mesh makes no stairs.
  /// @param u,v  numbers of the first path
  /// @param n    the slice; lit: whether it has light
  void darken(int u, int v, int n, bool lit, float* depth, int count) const;

 private:
  void cover(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
  std::ptrdiff_t rowAt(int v) const {
    return (static_cast<std::ptrdiff_t>(v) - window_.v0) * (window_.u1 - window_.u0);
  }

  int sign_, spacing_;
  PlaneWindow window_;        // the paths that the mesh may end
  std::vector<float> first_;  // by path: slices on the way of the light to where it ends
};

}  // namespace umbrick
