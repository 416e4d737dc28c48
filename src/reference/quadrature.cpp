// SPDX-License-Identifier: Apache-2.0
#include "reference/quadrature.h"
#include "umbrick/scene/capabilities.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace umbrick {
namespace {
constexpr double kDarkTau = 25;  // exp(-25) is 1.4e-11
}

std::vector<LightDirection> evenLight(const std::vector<WeightedDirection>& directions) {
  std::vector<LightDirection> lights;
  for (const auto& [direction, weight] : directions) lights.push_back({direction, glm::dvec3(weight)});
  return lights;
}

double opticalDepth(const Field& field, Field::Accessor& accessor, const Classifier& classifier, const IndexRay& ray,
                    const Interval& part, double limit, std::uint64_t& cells) {
  double tau = 0;
  field.walkBlocks(
      accessor, ray, part, [&](const FieldBlock& block, const glm::dvec3& origin, double begin, double end) {
        if (!block.values) {
          ++cells;
          tau += block.sigma_maj * (end - begin);
          return tau < limit;
        }
        return walkCells(block, origin, ray, begin, end, [&](const glm::ivec3& cell, double enter, double leave) {
          ++cells;
          const glm::dvec3 corner = origin + glm::dvec3(cell);
          const glm::dvec3 from = ray.at(enter) - corner, to = ray.at(leave) - corner;
          const std::uint8_t kind = block.kind(cell);
          if (kind != FieldBlock::kMixed) {
            const LinearStretch& stretch = classifier.stretch(kind - 1u);
            double sigma_t = stretch.sigma_t;
            if (stretch.sigmaSlope != 0)
              sigma_t += stretch.sigmaSlope * (TrilinearCell(block.values, cell).mean(from, to) - stretch.origin);
            tau += (leave - enter) * sigma_t;
            return tau < limit;
          }
          Cubic gradient;
          if (block.gradients) gradient = TrilinearCell(block.gradients, cell).along(from, to);
          classifier.forEachPiece(
              TrilinearCell(block.values, cell).along(from, to), gradient, [&](const CellPiece& piece) {
                tau += (leave - enter) * std::max(0.0, piece.sigma_t.integral(piece.begin, piece.end));
              });
          return tau < limit;
        });
      });
  return tau;
}

QuadraturePixel::QuadraturePixel(const ReferenceSpace& space, const ReferenceOptions& options, double step,
                                 double voxelEdge, const GoOn& goOn)
    : space_(space),
      options_(options),
      goOn_(goOn),
      step_(step),
      voxelEdge_(voxelEdge),
      accessor_(space.field.accessor()) {
  eyeOptions_.step = step;
  eyeOptions_.classifyVoxels = space.scene.sampling.classification == Classification::pre;
  // A part stands for the V at its centre, so its error goes with the square of its optical depth. Without V only the
  // albedo varies, and three Gauss nodes integrate exp(-x) over 0.5 to 1e-8.
  eyeOptions_.largestTau =
      !traitsOf(space.scene.model).occlusion ? 0.5 : std::clamp(2 * std::sqrt(options.tolerance), 1e-3, 0.1);
  if (isShaded(space.scene)) {
    shading_.emplace(space.grid, space.scene);
    eyeOptions_.largestTau = std::min(eyeOptions_.largestTau, 0.02);  // what is reflected is that of a part's centre
  }
  eyeOptions_.darkest = std::min(1e-6, 0.01 * options.tolerance);
  if (space.emission && emissionLights(space.scene))
    for (const auto& [direction, weight] : sphereDirections(options.directions))
      glow_.push_back({space.rays.toIndex(direction), glm::dvec3(weight), 0});
  aim(space.directions);
}

void QuadraturePixel::aim(const std::vector<LightDirection>& lights) {
  lights_.clear();
  glm::dvec3 sum(0);
  for (const LightDirection& light : lights) sum += light.radiance;
  const double power = sum.r + sum.g + sum.b;
  // Beside light that is emitted others are what they are, and no multiples of L_a.
  const glm::dvec3 scale = glow_.empty() ? glm::dvec3(1) : space_.scene.ambient;
  for (const auto& [direction, radiance] : lights)
    lights_.push_back({space_.rays.toIndex(direction), scale * radiance,
                       power > 0 ? (radiance.r + radiance.g + radiance.b) / power : 0});
  whole_ = sum;
  brightest_ = std::max({sum.r, sum.g, sum.b});
  // Where all light is emitted, tolerances are shares of about the light that is seen.
  if (!glow_.empty()) brightest_ = std::max({scale.r * sum.r, scale.g * sum.g, scale.b * sum.b, 0.1});
}

// Aims light that is around the ray to the eye.
void QuadraturePixel::aimAlong(const EyeRays::Ray& ray) {
  if (traitsOf(space_.scene.model).aroundRay)
    aim(evenLight(coneDirections(-ray.direction, space_.scene.occlusion.aperture, options_.directions)));
}

// Returns a light as shares of the whole one; colours that this lacks have none.
glm::dvec3 QuadraturePixel::shareOf(const glm::dvec3& light) const {
  glm::dvec3 share(0);
  for (int c = 0; c < 3; ++c) share[c] = whole_[c] > 0 ? light[c] / whole_[c] : 0;
  return share;
}

std::optional<QuadraturePixel::Share> QuadraturePixel::shareAt(const EyeRays::Ray& ray, const glm::dvec3& point,
                                                               const std::function<double(const IndexRay&)>& through) {
  aimAlong(ray);
  const Arriving arriving = arrivingAt(point, through);
  if (stopped_) return std::nullopt;
  return Share{shareOf(arriving.light), arriving.visibility};
}

std::optional<PixelResult> QuadraturePixel::integrate(int x, int y) {
  PixelResult mean;
  for (const glm::dvec2& place : space_.places) {
    const EyeRays::Ray ray = space_.rays.through(x, y, place);
    const std::optional<MeshEnd> end = space_.mesh ? space_.mesh->find(ray) : std::nullopt;
    std::optional<PixelResult> result = integrate(ray, {0, endOf(end)});
    if (!result) return std::nullopt;
    if (end) {
      const double through = 1 - result->opacity;
      result->light += through * end->reflected;
      result->visibility += through;
      result->depth += through * end->t * ray.depthPerLength;
      result->opacity = 1;
    }
    if (space_.places.size() == 1) return result;
    mean.add(*result, 1.0 / static_cast<double>(space_.places.size()));
  }
  return mean;
}

std::optional<PixelResult> QuadraturePixel::integrate(const EyeRays::Ray& ray, const Interval& seen) {
  PixelResult result;
  Interval part = space_.region.clip(ray.index, seen.begin);
  part.end = std::min(part.end, seen.end);
  if (part.empty()) return result;
  ++counts_.eyeRays;
  parts_.clear();
  std::optional<Emitted> emitted;
  if (space_.emission) emitted.emplace(*space_.emission);
  result.opacity = collectScatterers(space_.field, accessor_, space_.classifier, ray.index, part, eyeOptions_, parts_,
                                     counts_.cells, emitted ? &*emitted : nullptr);
  if (emitted) result.emitted = emitted->light;
  if (parts_.empty()) return result;
  if (shading_) shade(ray.index, result);
  if (!traitsOf(space_.scene.model).occlusion) {
    for (const Scatterer& p : parts_) {
      result.light += p.light;
      result.visibility += p.alpha;
      result.depth += p.alpha * p.t;
    }
    result.depth *= ray.depthPerLength;
    return result;
  }
  aimAlong(ray);
  before_.assign(1, Scatterer{});
  before_.reserve(parts_.size() + 1);
  for (const Scatterer& p : parts_) {
    const Scatterer& last = before_.back();
    before_.push_back({last.t + p.alpha * p.t, last.alpha + p.alpha, last.light + p.light, 0});
  }
  result.depth = before_.back().t * ray.depthPerLength;
  const Sum sum = step_ > 0 ? integrateSteps(ray.index) : integrateAdaptive(ray.index);
  if (!glow_.empty())
    result.emitted += sum.light;  // with L_a in it
  else
    result.light += shading_ ? shareOf(sum.light) : sum.light;
  // What is reflected is light and all; the medium's own visibility is no part of it.
  result.visibility = shading_ ? before_.back().alpha : sum.visibility;
  if (stopped_) return std::nullopt;
  return result;
}

// Takes what the medium sends without a light, and makes the rest of it what the parts scatter.
void QuadraturePixel::shade(const IndexRay& ray, PixelResult& result) {
  for (Scatterer& p : parts_) {
    result.light += p.light * shading_->ambient();
    p.light *= shading_->direct(ray.at(p.t));
  }
}

// Returns the mean, over all directions, of the emitted light that arrives at a point.
glm::dvec3 QuadraturePixel::glowAt(const glm::dvec3& point) {
  glm::dvec3 sum(0);
  for (const auto& [direction, weight, share] : glow_) {
    if (!stopped_ && !goOn_()) stopped_ = true;
    if (stopped_) return sum;
    ++counts_.lightRays;
    const IndexRay ray(point, direction);
    const Interval part = space_.region.clip(ray, 0);
    if (part.empty()) continue;
    Emitted emitted{*space_.emission};
    onTheWay_.clear();
    collectScatterers(space_.field, accessor_, space_.classifier, ray, part, eyeOptions_, onTheWay_, counts_.cells,
                      &emitted);
    sum += weight * emitted.light;
  }
  return sum;
}

QuadraturePixel::Arriving QuadraturePixel::arrivingAt(const glm::dvec3& point,
                                                      const std::function<double(const IndexRay&)>& through) {
  ++counts_.samples;
  // V takes time in proportion to its directions, so the job may be stopped here. That ends the pixel, whose result
  // does not count then.
  if (!stopped_ && !goOn_()) stopped_ = true;
  Arriving sum;
  if (stopped_) return sum;
  for (const auto& [direction, radiance, share] : lights_) {
    ++counts_.lightRays;
    // Some rays take long by themselves, through many cells or many points of the transfer function.
    constexpr std::uint64_t kCellsBetween = 4096;
    if (counts_.cells - askedAt_ > kCellsBetween) {
      askedAt_ = counts_.cells;
      if (!goOn_()) stopped_ = true;
      if (stopped_) return sum;
    }
    const IndexRay light(point, direction);
    if (space_.mesh && space_.mesh->isAlong(light)) continue;
    const Interval part = space_.region.clip(light, 0);
    double tau = 0;
    if (!part.empty())
      tau = opticalDepth(space_.field, accessor_, space_.classifier, light, part, kDarkTau, counts_.cells);
    double transmittance = std::exp(-tau);
    if (through && transmittance > 0) transmittance *= through(light);
    sum.light += transmittance * radiance;
    sum.visibility += transmittance * share;
  }
  if (!glow_.empty()) sum.light += glowAt(point);
  return sum;
}

// Returns the light that arrives where the scattering of these parts has its centre.
QuadraturePixel::Arriving QuadraturePixel::meanArriving(const IndexRay& ray, std::size_t begin, std::size_t end) {
  const Scatterer &first = before_[begin], &last = before_[end];
  // Sums lose digits where there is little, so the centre is kept inside.
  const double centre = (last.t - first.t) / (last.alpha - first.alpha);
  return arrivingAt(
      ray.at(std::isfinite(centre) ? std::clamp(centre, parts_[begin].t, parts_[end - 1].t) : parts_[begin].t));
}

QuadraturePixel::Sum QuadraturePixel::weigh(std::size_t begin, std::size_t end, const Arriving& arriving) const {
  const Scatterer &first = before_[begin], &last = before_[end];
  const double alpha = last.alpha - first.alpha;
  return {arriving.light * (last.light - first.light), alpha * arriving.light, alpha * arriving.visibility};
}

// Halves the parts by weight until the two halves agree with the whole.
QuadraturePixel::Sum QuadraturePixel::refine(const IndexRay& ray, std::size_t begin, std::size_t end,
                                             const Arriving& arriving, int depth) {
  const Sum whole = weigh(begin, end, arriving);
  if (end - begin < 2 || depth == 0) return whole;
  const double middle = 0.5 * (before_[begin].alpha + before_[end].alpha);
  const auto place = std::lower_bound(before_.begin() + static_cast<std::ptrdiff_t>(begin) + 1,
                                      before_.begin() + static_cast<std::ptrdiff_t>(end) - 1, middle,
                                      [](const Scatterer& a, double alpha) { return a.alpha < alpha; });
  const auto split = static_cast<std::size_t>(place - before_.begin());
  const Arriving near = meanArriving(ray, begin, split), far = meanArriving(ray, split, end);
  const Sum halves = weigh(begin, split, near) + weigh(split, end, far);
  const glm::dvec3 change = glm::abs(halves.arriving - whole.arriving);
  if (std::max({change.r, change.g, change.b}) <= options_.tolerance * brightest_) return halves;
  return refine(ray, begin, split, near, depth - 1) + refine(ray, split, end, far, depth - 1);
}

// Begins with stretches that are short enough for the first comparison to mean something.
QuadraturePixel::Sum QuadraturePixel::integrateAdaptive(const IndexRay& ray) {
  Sum sum;
  std::size_t begin = 0;
  while (begin < parts_.size()) {
    std::size_t end = begin + 1;
    while (end < parts_.size() && before_[end + 1].alpha - before_[begin].alpha <= 0.25 &&
           (parts_[end].t - parts_[begin].t <= 16 * voxelEdge_ ||
            before_[end + 1].alpha - before_[begin].alpha <= options_.tolerance))
      ++end;
    sum = sum + refine(ray, begin, end, meanArriving(ray, begin, end), 20);
    begin = end;
  }
  return sum;
}

QuadraturePixel::Sum QuadraturePixel::integrateSteps(const IndexRay& ray) {
  Sum sum;
  for (std::size_t begin = 0; begin < parts_.size();) {
    std::size_t end = begin + 1;
    while (end < parts_.size() && parts_[end].stretch == parts_[begin].stretch) ++end;
    sum = sum + weigh(begin, end, meanArriving(ray, begin, end));
    begin = end;
  }
  return sum;
}

}  // namespace umbrick
