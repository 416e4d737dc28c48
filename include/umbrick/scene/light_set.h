// The light of a scene as distributions of directions that can be listed and sampled.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "umbrick/scene/lights.h"

namespace umbrick {

/// Returns how much a radiance counts when lights share directions, and in V: the mean of R, G and B.
inline double powerOf(const glm::dvec3& radiance) { return (radiance.r + radiance.g + radiance.b) / 3; }

/// One source of light, with its directions in the world.
class Light {
 public:
  virtual ~Light() = default;
  /// Returns the mean of R, G and B that a point of albedo 1 scatters when nothing is in the way.
  double power() const { return power_; }
  /// Returns the solid angle that the light comes from, sr; 0 where directions() is the same for any count.
  double solidAngle() const { return solidAngle_; }
  /// Returns about `count` directions whose radiances sum to the light.
  virtual std::vector<LightDirection> directions(int count, double rotation) const = 0;
  /// Returns a direction that is chosen by power; the mean of its radiance over (u, v) in [0, 1)^2 is the light.
  /// @pre the light has power
  virtual LightDirection sample(double u, double v) const = 0;

 protected:
  Light() = default;
  Light(double power, double solidAngle) : power_(power), solidAngle_(solidAngle) {}
  void setSize(double power, double solidAngle) {
    power_ = power;
    solidAngle_ = solidAngle;
  }

 private:
  double power_ = 0, solidAngle_ = 0;
};

/// The sources of a scene together. Integrators take directions, or one at random, from here.
class LightSet {
 public:
  /// @throw InvalidArgument  as lightDirections
  explicit LightSet(const ResolvedScene& scene);
  /// Takes these directions and no others.
  explicit LightSet(std::vector<LightDirection> directions);

  std::vector<LightDirection> directions(int count, double rotation) const;
  std::vector<LightDirection> samples(std::uint64_t first, int count, std::uint64_t seed) const;
  /// Returns one direction of one source, chosen by power; the mean of its radiance over [0, 1)^3 is the light.
  LightDirection sample(double source, double u, double v) const;

  std::size_t size() const { return lights_.size(); }
  double power() const { return power_; }

 private:
  std::vector<int> shares(int count) const;

  std::vector<std::unique_ptr<Light>> lights_;
  double power_ = 0;
};

}  // namespace umbrick
