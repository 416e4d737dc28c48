// Meshes that tests make.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <string>

#include "umbrick/mesh/mesh.h"

namespace umbrick {

/// A sphere of quadrilaterals that are cut in two, with the normals of the sphere. Between its corners, which lie on
/// it, a triangle is inside of it by at most the square of half its edge over 2 r: 1.3 r / rings^2 or so.
inline TriangleMesh sphereMesh(const glm::dvec3& centre, double radius, unsigned rings) {
  TriangleMesh mesh;
  const unsigned around = 2 * rings;
  for (unsigned i = 0; i <= rings; ++i)
    for (unsigned k = 0; k < around; ++k) {
      const double polar = std::numbers::pi * i / rings, azimuth = 2 * std::numbers::pi * k / around;
      const glm::dvec3 normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
      mesh.normals.push_back(normal);
      mesh.vertices.push_back(centre + radius * normal);
    }
  for (unsigned i = 0; i < rings; ++i)
    for (unsigned k = 0; k < around; ++k) {
      const unsigned a = i * around + k, b = i * around + (k + 1) % around;
      mesh.triangles.emplace_back(a, a + around, b);
      mesh.triangles.emplace_back(b, a + around, b + around);
    }
  return mesh;
}

/// A square in the plane z = `height`.
inline TriangleMesh squareMesh(const glm::dvec2& low, const glm::dvec2& high, double height) {
  return {{{low.x, low.y, height}, {high.x, low.y, height}, {high.x, high.y, height}, {low.x, high.y, height}},
          {},
          {{0, 1, 2}, {0, 2, 3}}};
}

/// A file's text: vertices, and polygons that count them from `first` on.
inline std::string plyOf(const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const glm::dvec3& v : mesh.vertices)
    text += std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
  for (const glm::uvec3& t : mesh.triangles)
    text += "3 " + std::to_string(t.x) + ' ' + std::to_string(t.y) + ' ' + std::to_string(t.z) + '\n';
  return text;
}
inline std::string objOf(const TriangleMesh& mesh) {
  std::string text = "mtllib nowhere.mtl\no thing\n";
  for (const glm::dvec3& v : mesh.vertices)
    text += "v " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
  for (const glm::uvec3& t : mesh.triangles)
    text += "f " + std::to_string(t.x + 1) + ' ' + std::to_string(t.y + 1) + ' ' + std::to_string(t.z + 1) + '\n';
  return text;
}

}  // namespace umbrick
