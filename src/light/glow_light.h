// The light of what emits, as it reaches the medium around it: fire that lights its smoke.
//
// It is the mean, over all directions, of the radiance that arrives at a point:
//
//     L(X) = 1 / (4 pi) Int Int T(X, X + s w) L_e(X + s w) ds dw
//
// so that a medium that scatters alike in all directions sends sigma_s L(X) per world unit (one bounce). It varies
// slowly but where something emits, so that it is computed in coarse cells, of which no volume has more than
// kMostCells, from the means of sigma_t and L_e over the voxels of each. Each direction goes through the cells slice by
// slice, as light in light_sweep.h does, but radiance is interpolated bilinearly from slice to slice (short
// characteristics: Kunasz & Auer 1988, J. Quant. Spectrosc. Radiat. Transfer 39 (1), 67-79): what that blurs, the mean
// over directions blurs more.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "umbrick/light/light_volume.h"

namespace umbrick {

/// The light of what emits.
class GlowLight {
 public:
  static constexpr int kMostCells = 64 * 64 * 64;
  static constexpr int kDirections = 144;

  /// Computes the light of a medium, where it has any and anything that it depends on has changed.
  void update(const Bricks& volume, const LightMedium& medium);
  /// Tells whether there is any.
  bool any() const { return most_ != glm::vec3(0); }
  /// The largest light by channel.
  const glm::vec3& most() const { return most_; }
  /// Returns the light at a point, index coordinates.
  glm::vec3 at(const glm::vec3& place) const;
  /// Voxels along an edge of a cell.
  int cellEdge() const { return cell_; }

 private:
  struct Key {
    TransferFunction transfer, emitted;
    std::vector<glm::dvec4> planes;
    bool operator==(const Key&) const = default;
  };

  void chooseCells(const IndexBox& domain);
  void fill(const Bricks& volume, const Key& key);
  void propagate(const glm::dmat4& indexToWorld);
  std::size_t placeOf(const glm::ivec3& cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(cell.y)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(cell.x);
  }

  std::optional<Key> key_;
  glm::ivec3 origin_{0}, size_{0};  // first voxel, and cells along each axis
  int cell_ = 1;
  glm::vec3 most_{0};
  // By cell: sigma_t and L_e, until the light is known; and the light.
  std::vector<float> extinction_;
  std::vector<glm::vec3> emitted_, light_;
};

}  // namespace umbrick
