// SPDX-License-Identifier: Apache-2.0
#include "reference/monte_carlo.h"
#include "umbrick/scene/capabilities.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace umbrick {
namespace {

constexpr double kPi = std::numbers::pi;

// The cell of a block in which a point lies, and where in it.
struct CellPlace {
  glm::ivec3 cell;
  glm::dvec3 inside;
};
CellPlace placeIn(const glm::dvec3& local) {
  const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(local)), glm::ivec3(0), glm::ivec3(FieldBlock::kCells - 1));
  return {cell, glm::clamp(local - glm::dvec3(cell), glm::dvec3(0), glm::dvec3(1))};
}

Medium mediumAt(const FieldBlock& block, const glm::dvec3& local, const TransferFunction& transfer) {
  if (!block.values) return transfer(block.uniform, 0);
  const auto [cell, inside] = placeIn(local);
  if (!block.sees(cell)) return {};
  const double gradient = block.gradients ? TrilinearCell(block.gradients, cell)(inside) : 0;
  return transfer(TrilinearCell(block.values, cell)(inside), gradient);
}

// Mean and squared deviations of numbers, updated as they come in. Welford 1962.
class RunningMoments {
 public:
  void add(const std::array<double, 6>& x) {
    ++count_;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double change = x[i] - mean_[i];
      mean_[i] += change / count_;
      squares_[i] += change * (x[i] - mean_[i]);
    }
  }
  double mean(std::size_t i) const { return mean_[i]; }
  /// Returns the variance of the mean.
  double variance(std::size_t i) const { return count_ < 2 ? 0 : squares_[i] / (count_ - 1.0) / count_; }

 private:
  int count_ = 0;
  std::array<double, 6> mean_{}, squares_{};
};

}  // namespace

// Calls visit(t, medium, sigma_maj, L_e) at tentative collisions, until it returns false. Their density is the majorant
// of each block. But in a block that is much denser somewhere than a voxel is wide, each cell has a majorant of its
// own; else a ray would be stopped again and again on its way through the thin parts.
template <class Visit>
void MonteCarloPixel::trackBlocks(const IndexRay& ray, const Interval& part, Random& random, const Visit& visit) {
  const TransferFunction& transfer = space_.classifier.transfer();
  double tau = -std::log(random.uniform());  // optical depth to the next collision, by the majorants
  const auto track = [&](const FieldBlock& block, const glm::dvec3& origin, double majorant, double t, double end) {
    const double sigma_maj = std::min(block.emissions ? std::max(majorant, glowing_) : majorant, densest_);
    while (tau < sigma_maj * (end - t)) {
      t += tau / sigma_maj;
      tau = -std::log(random.uniform());
      ++counts_.samples;
      Medium medium = mediumAt(block, ray.at(t) - origin, transfer);
      medium.sigma_t = std::min(medium.sigma_t, densest_);
      if (!visit(t, medium, sigma_maj, radianceAt(block, ray.at(t) - origin))) return false;
    }
    tau -= sigma_maj * (end - t);
    return true;
  };
  space_.field.walkBlocks(
      accessor_, ray, part, [&](const FieldBlock& block, const glm::dvec3& origin, double begin, double end) {
        ++counts_.cells;
        if (!block.values || block.sigma_maj < dense_) return track(block, origin, block.sigma_maj, begin, end);
        return walkCells(block, origin, ray, begin, end, [&](const glm::ivec3& cell, double enter, double leave) {
          ++counts_.cells;
          return track(block, origin, majorantOf(block, cell), enter, leave);
        });
      });
}

double MonteCarloPixel::majorantOf(const FieldBlock& block, const glm::ivec3& cell) const {
  const Range gradients = block.gradients ? rangeOfCell(block.gradients, cell) : Range{0, 0};
  return space_.classifier.transfer().majorant(rangeOfCell(block.values, cell), gradients);
}

glm::dvec3 MonteCarloPixel::radianceAt(const FieldBlock& block, const glm::dvec3& local) const {
  if (!block.emissions) return glm::dvec3(0);
  const auto [cell, inside] = placeIn(local);
  return space_.emission->transfer()(TrilinearCell(block.emissions, cell)(inside)).sigma_s();
}

// Tentative collisions up to the first real one have the density T sigma_maj, so that the sum of L_e / sigma_maj over
// them has the mean Int T L_e ds.
MonteCarloPixel::Collision MonteCarloPixel::collide(const IndexRay& ray, const Interval& part, Random& random) {
  Collision collision;
  trackBlocks(ray, part, random, [&](double t, const Medium& medium, double sigma_maj, const glm::dvec3& radiance) {
    collision.emitted += radiance / sigma_maj;
    if (random.uniform() * sigma_maj >= medium.sigma_t) return true;
    collision = {true, t, medium, collision.emitted};
    return false;
  });
  return collision;
}

// Returns one direction of light, chosen at random, with a radiance whose mean over all choices is the light.
LightDirection MonteCarloPixel::chooseLight(const glm::dvec3& towardsEye, Random& random) const {
  const ResolvedScene& scene = space_.scene;
  const double source = space_.lights && space_.lights->size() > 1 ? random.uniform() : 0;
  const double u = random.uniform(), v = random.uniform();
  if (space_.lights) return space_.lights->sample(source, u, v);
  const double aperture = traitsOf(scene.model).sphere ? kPi : scene.occlusion.aperture;
  return {sampleCone(towardsEye, aperture, u, v), glm::dvec3(1)};
}

double MonteCarloPixel::estimateTransmittance(const glm::dvec3& point, const glm::dvec3& direction, Random& random) {
  const IndexRay light(point, space_.rays.toIndex(direction));
  ++counts_.lightRays;
  const Interval part = space_.region.clip(light, 0);
  double transmittance = 1;
  if (part.empty()) return transmittance;
  trackBlocks(light, part, random, [&](double, const Medium& medium, double sigma_maj, const glm::dvec3&) {
    transmittance *= 1 - medium.sigma_t / sigma_maj;
    // Russian roulette: a path that is nearly dark goes on only now and then, and then counts for more.
    if (transmittance < 0.1) {
      if (random.uniform() >= 10 * transmittance) {
        transmittance = 0;
        return false;
      }
      transmittance = 0.1;
    }
    return true;
  });
  return transmittance;
}

// Returns what one path along a ray finds: light, opacity, visibility, depth.
MonteCarloPixel::Found MonteCarloPixel::trace(const EyeRays::Ray& ray, const Interval& part, Random& random) {
  ++counts_.eyeRays;
  const Collision hit = collide(ray.index, part, random);
  const glm::dvec3 seen = hit.emitted;
  if (!hit.happened) return {seen.x, seen.y, seen.z, 0, 0, 0};
  double visibility = 1;
  glm::dvec3 light = hit.medium.albedo;
  if (traitsOf(space_.scene.model).occlusion) {
    const glm::dvec3 towardsEye = traitsOf(space_.scene.model).aroundRay ? -ray.direction : towardsEye_;
    const LightDirection chosen = chooseLight(towardsEye, random);
    const double transmittance = estimateTransmittance(ray.index.at(hit.t), chosen.direction, random);
    light *= transmittance * chosen.radiance;
    visibility = power_ > 0 ? transmittance * powerOf(chosen.radiance) / power_ : 0;
  }
  if (space_.emission) {
    light *= space_.scene.ambient;
    if (emissionLights(space_.scene)) {
      const double u = random.uniform(), v = random.uniform();
      const IndexRay from(ray.index.at(hit.t), space_.rays.toIndex(sampleCone(towardsEye_, kPi, u, v)));
      ++counts_.lightRays;
      const Interval way = space_.region.clip(from, 0);
      if (!way.empty()) light += hit.medium.albedo * collide(from, way, random).emitted;
    }
    light += seen;
  }
  return {light.x, light.y, light.z, 1, visibility, hit.t * ray.depthPerLength};
}

std::optional<PixelResult> MonteCarloPixel::integrate(int x, int y) {
  PixelResult result;
  std::vector<std::pair<EyeRays::Ray, Interval>> rays;
  bool meetsMedium = false;
  for (const glm::dvec2& place : space_.places) {
    const EyeRays::Ray ray = space_.rays.through(x, y, place);
    rays.emplace_back(ray, space_.region.clip(ray.index, 0));
    meetsMedium = meetsMedium || !rays.back().second.empty();
  }
  if (!meetsMedium) return result;
  const int width = space_.scene.camera.width;
  Random random(options_.seed,
                static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width) + static_cast<std::uint64_t>(x));
  RunningMoments moments;
  // An event that n paths did not see has a probability of the order of 1 / n: a pixel whose paths all agree is not
  // known better than that.
  const int least =
      options_.standardError > 0 ? std::max(64, static_cast<int>(std::min(1e9, 1 / options_.standardError))) : 0;
  const bool wanted = options_.standardError > 0;
  result.converged = !wanted;
  // A round is one path along each ray of the pixel. Its mean is one independent sample of the pixel: what the rays
  // differ by is no error, and does not count as one.
  constexpr int kLeastRounds = 32;
  const int round = static_cast<int>(rays.size()), rounds = options_.samples / round;
  for (int i = 1; i <= rounds; ++i) {
    const int paths = i * round;
    if (paths / 16 != (paths - round) / 16 && !goOn_()) return std::nullopt;
    Found mean{};
    for (const auto& [ray, part] : rays) {
      if (part.empty()) continue;
      const Found found = trace(ray, part, random);
      for (std::size_t k = 0; k < found.size(); ++k) mean[k] += found[k] / round;
    }
    moments.add(mean);
    if (!wanted || paths < least || i < kLeastRounds || i % 16 != 0) continue;
    double largest = 0;
    for (std::size_t k = 0; k < 4; ++k) largest = std::max(largest, moments.variance(k));
    result.converged = std::sqrt(largest) <= options_.standardError;
    if (result.converged) break;
  }
  (space_.emission ? result.emitted : result.light) = {moments.mean(0), moments.mean(1), moments.mean(2)};
  result.opacity = moments.mean(3);
  result.visibility = moments.mean(4);
  result.depth = moments.mean(5);
  result.variance = {moments.variance(0), moments.variance(1), moments.variance(2), moments.variance(3)};
  return result;
}

}  // namespace umbrick
