// An opaque mesh of triangles in the world, and where rays meet it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/box.h"

namespace umbrick {

/// Triangles by their corners, world units.
struct TriangleMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::dvec3> normals;  // of the vertices, any length; none at all: triangles are flat
  std::vector<glm::uvec3> triangles;
};

/// Triangles that are sorted for rays, which Embree intersects. It does not change any more, and several threads may
/// ask it at the same time.
class Mesh {
 public:
  /// @param name  what messages call it, such as the name of its file
  /// @throw InvalidArgument  there is no triangle, a corner is none of the vertices, a vertex is not finite, or the
  ///   mesh is larger than 1e18 world units
  explicit Mesh(const TriangleMesh& triangles, const std::string& name = "mesh");
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  struct Hit {
    double t = 0;          // along the ray
    glm::dvec3 normal{0};  // unit length, on either side
  };
  /// Finds where the ray origin + t direction meets the mesh first. Triangles are found in single precision of the
  /// mesh's size, and t, in the plane of the triangle, in double precision.
  /// @param direction  of any length but 0
  /// @param from  what is nearer does not count
  std::optional<Hit> first(const glm::dvec3& origin, const glm::dvec3& direction, double from) const;

  std::size_t triangles() const;
  /// Returns the corners of the triangles, world units, and which of them each triangle has.
  std::vector<glm::dvec3> vertices() const;
  const std::vector<glm::uvec3>& corners() const;
  const Box& bounds() const;
  /// Tells whether all corners and normals are the same.
  bool operator==(const Mesh& other) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace umbrick
