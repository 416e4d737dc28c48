// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/light_set.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <string>

#include "scene/environment.h"
#include "scene/light_check.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"
#include "umbrick/optics/directions.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// A cone whose directions are those of the light's own frame, so that a light that moves with the camera keeps them.
class UniformCone : public Light {
 public:
  UniformCone(const ConeLight& cone, const glm::dmat3& toWorld)
      : Light(powerOf(cone.radiance), 2 * std::numbers::pi * (1 - std::cos(cone.aperture))),
        cone_(cone),
        toWorld_(toWorld) {}

  std::vector<LightDirection> directions(int count, double rotation) const override {
    std::vector<LightDirection> result;
    const bool few = count <= 64;  // with more directions, exact rings are better where light is smooth
    for (const auto& [direction, weight] : few ? spiralDirections(cone_.axis, cone_.aperture, count, rotation)
                                               : coneDirections(cone_.axis, cone_.aperture, count, rotation))
      result.push_back({glm::normalize(toWorld_ * direction), weight * cone_.radiance});
    return result;
  }
  LightDirection sample(double u, double v) const override {
    return {glm::normalize(toWorld_ * sampleCone(cone_.axis, cone_.aperture, u, v)), cone_.radiance};
  }

 private:
  ConeLight cone_;
  glm::dmat3 toWorld_;
};

double sumOfPowers(const std::vector<LightDirection>& list) {
  double power = 0;
  for (const LightDirection& light : list) power += powerOf(light.radiance);
  return power;
}

class ListOfDirections : public Light {
 public:
  explicit ListOfDirections(std::vector<LightDirection> list) : Light(sumOfPowers(list), 0), list_(std::move(list)) {
    double sum = 0;
    for (const LightDirection& light : list_) sums_.push_back(sum += powerOf(light.radiance));
  }

  std::vector<LightDirection> directions(int, double) const override { return list_; }
  LightDirection sample(double u, double) const override {
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), u * sums_.back());
    const auto index = std::min<std::size_t>(static_cast<std::size_t>(found - sums_.begin()), list_.size() - 1);
    const LightDirection& light = list_[index];
    const double power = powerOf(light.radiance);
    return {light.direction, power > 0 ? light.radiance * (sums_.back() / power) : glm::dvec3(0)};
  }

 private:
  std::vector<LightDirection> list_;
  std::vector<double> sums_;  // sum of the powers up to and including each one
};

std::unique_ptr<Light> makeLight(const ConeLight& cone, const glm::dmat3& toWorld, const glm::dvec3&, bool) {
  return std::make_unique<UniformCone>(cone, toWorld);
}

std::unique_ptr<Light> makeLight(const ListedLight& light, const glm::dmat3& toWorld, const glm::dvec3&, bool) {
  std::vector<LightDirection> list;
  for (const ListedDirection& listed : light.list)
    list.push_back({glm::normalize(toWorld * listed.direction), listed.weight * listed.colour});
  return std::make_unique<ListOfDirections>(std::move(list));
}

std::unique_ptr<Light> makeLight(const EnvironmentLight& light, const glm::dmat3& toWorld, const glm::dvec3& viewer,
                                 bool whole) {
  return std::make_unique<Environment>(light, toWorld, viewer, whole);
}

// Point `index` of the sequence R2: multiples of 1/g and 1/g^2, with g^3 = g + 1. It is computed in fixed point, so
// that no index is too large for it.
struct UnitPoint {
  double u, v;
};
UnitPoint pointOfR2(std::uint64_t index, std::uint64_t shiftU, std::uint64_t shiftV) {
  constexpr std::uint64_t kU = 13925035116211876495u, kV = 10511698010929265437u;  // 2^64 / g, 2^64 / g^2
  const auto toUnit = [](std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; };
  return {toUnit(shiftU + index * kU), toUnit(shiftV + index * kV)};
}

std::uint64_t wide(Random& random) {
  const std::uint64_t high = random.next();
  return high << 32 | random.next();
}

void checkCount(int count) {
  if (count < 1) throw InvalidArgument("directions: expected at least 1, found " + std::to_string(count));
}

}  // namespace

LightSet::LightSet(const ResolvedScene& scene) {
  const CameraFrame frame = cameraFrame(scene.camera);
  const glm::dmat3 viewToWorld(frame.right, frame.up, -frame.forward);
  const ModelTraits& model = traitsOf(scene.model);
  if (model.directions && model.cone) {
    lights_.push_back(
        makeLight(ConeLight{{0, 0, 1}, scene.occlusion.aperture, glm::dvec3(1)}, viewToWorld, -frame.forward, false));
  } else if (model.sphere) {
    // The whole sphere is a cone; its directions are those of the world, so that they stay as the camera moves.
    lights_.push_back(
        std::make_unique<UniformCone>(ConeLight{{0, 0, 1}, std::numbers::pi, glm::dvec3(1)}, glm::dmat3(1)));
  } else if (model.directions) {
    const bool whole = lightComesFromBehind(scene);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
      const LightSource& source = scene.lights[i];
      const bool view = source.frame == LightFrame::view;
      auto complaint = findComplaint(source, i);
      if (!complaint && !whole) complaint = findBehindViewer(source, i, view ? glm::dvec3(0, 0, 1) : -frame.forward);
      if (complaint) throw InvalidArgument(complaint->field + ": " + complaint->message);
      const glm::dmat3 toWorld = view ? viewToWorld : glm::dmat3(1);
      lights_.push_back(std::visit([&](const auto& light) { return makeLight(light, toWorld, -frame.forward, whole); },
                                   source.light));
    }
    if (lights_.empty())
      throw InvalidArgument("light.sources: is empty, must be one source or more for the model lights");
  } else {
    throw InvalidArgument("lights: the model " + modelName(scene.model) +
                          " has no list of directions; cone, ambient and lights have one");
  }
  for (const auto& light : lights_) power_ += light->power();
}

LightSet::LightSet(std::vector<LightDirection> directions) {
  lights_.push_back(std::make_unique<ListOfDirections>(std::move(directions)));
  power_ = lights_.front()->power();
}

// Returns how many of `count` directions each source takes; 1 for sources whose number does not depend on it.
std::vector<int> LightSet::shares(int count) const {
  std::vector<double> wanted;
  double sum = 0;
  int left = count;
  for (const auto& light : lights_) {
    wanted.push_back(light->power() * std::sqrt(light->solidAngle()));
    sum += wanted.back();
    if (light->solidAngle() == 0) left -= static_cast<int>(light->directions(1, 0).size());
  }
  std::vector<int> result;
  double carried = 0;
  for (const double want : wanted) {
    if (sum > 0) carried += std::max(0, left) * (want / sum);
    const int whole = want > 0 ? std::max(1, static_cast<int>(std::lround(carried))) : 1;
    if (want > 0) carried -= whole;
    result.push_back(whole);
  }
  return result;
}

std::vector<LightDirection> LightSet::directions(int count, double rotation) const {
  checkCount(count);
  const std::vector<int> share = shares(count);
  std::vector<LightDirection> result;
  for (std::size_t i = 0; i < lights_.size(); ++i)
    for (const LightDirection& light : lights_[i]->directions(share[i], rotation)) result.push_back(light);
  return result;
}

std::vector<LightDirection> LightSet::samples(std::uint64_t first, int count, std::uint64_t seed) const {
  checkCount(count);
  const std::vector<int> share = shares(count);
  const auto set = static_cast<std::uint64_t>(count);
  std::vector<LightDirection> result;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const Light& light = *lights_[i];
    if (light.solidAngle() == 0 || light.power() == 0) {
      for (const LightDirection& direction : light.directions(1, 0)) result.push_back(direction);
      continue;
    }
    Random random(seed, i);
    const std::uint64_t shiftU = wide(random), shiftV = wide(random);
    const auto n = static_cast<std::uint64_t>(share[i]);
    const std::uint64_t begin = first / set * n + first % set * n / set;
    for (std::uint64_t k = begin; k < begin + n; ++k) {
      const auto [u, v] = pointOfR2(k, shiftU, shiftV);
      const LightDirection sample = light.sample(u, v);
      result.push_back({sample.direction, sample.radiance / static_cast<double>(n)});
    }
  }
  return result;
}

LightDirection LightSet::sample(double source, double u, double v) const {
  double below = source * power_;
  const Light* chosen = nullptr;
  for (const auto& light : lights_) {
    if (light->power() == 0) continue;
    chosen = light.get();
    if (below < light->power()) break;
    below -= light->power();
  }
  // Where no light has power any direction will do.
  if (!chosen) return {lights_.front()->directions(1, 0).front().direction, glm::dvec3(0)};
  const LightDirection sample = chosen->sample(u, v);
  return {sample.direction, lights_.size() == 1 ? sample.radiance : sample.radiance * (power_ / chosen->power())};
}

}  // namespace umbrick
