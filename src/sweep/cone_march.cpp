// SPDX-License-Identifier: Apache-2.0
#include "sweep/cone_march.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "sweep/lattice_walk.h"
#include "sweep/voxel_point.h"
#include "umbrick/optics/medium.h"

namespace umbrick {
namespace {

// sigma_t, then sigma_s of red, green and blue, 1/world unit.
glm::dvec4 pointOf(const MediumTable& table, double steps) {
  const double inside = std::clamp(steps, 0.0, static_cast<double>(table.steps()));
  const int below = std::min(static_cast<int>(inside), table.steps() - 1);
  const float* const a = table.points() + static_cast<std::ptrdiff_t>(kMediumNumbers) * below;
  const double share = inside - below;
  glm::dvec4 medium;
  for (int i = 0; i < kMediumNumbers; ++i)
    medium[i] =
        static_cast<double>(a[i]) + share * (static_cast<double>(a[i + kMediumNumbers]) - static_cast<double>(a[i]));
  return medium;
}

// The integral from step 0 on. Beyond its ends the function is constant.
glm::dvec4 integralTo(const MediumTable& table, double steps) {
  const double inside = std::clamp(steps, 0.0, static_cast<double>(table.steps()));
  const int below = std::min(static_cast<int>(inside), table.steps() - 1);
  const std::int32_t* const sums = table.sums() + static_cast<std::ptrdiff_t>(kMediumNumbers) * below;
  const std::int32_t* const rests =
      table.rests() ? table.rests() + static_cast<std::ptrdiff_t>(kMediumNumbers) * below : nullptr;
  const double share = inside - below;
  const auto unitsAt = [&](int i) {
    return sums[i] + (rests ? static_cast<double>(rests[i]) / MediumTable::kRests : 0.0);
  };
  glm::dvec4 sum;
  for (int i = 0; i < kMediumNumbers; ++i) {
    const double low = unitsAt(i), high = unitsAt(i + kMediumNumbers);
    sum[i] = static_cast<double>(table.sumUnit()) * (low + share * (high - low));
  }
  return sum + (steps - inside) * pointOf(table, steps);
}

// The mean over a value that runs linearly from one to another.
glm::dvec4 meanOf(const MediumTable& table, double from, double to) {
  // Within a few steps of the table its points say more than differences of its integrals.
  if (std::abs(to - from) < 4) return 0.5 * (pointOf(table, from) + pointOf(table, to));
  return glm::max((integralTo(table, to) - integralTo(table, from)) / (to - from), glm::dvec4(0));
}

}  // namespace

ConeMarch::ConeMarch(const ConeFrame& frame)
    : frame_(frame),
      toWorld_(frame.voxels->volume().indexToWorld),
      toIndex_(glm::inverse(glm::dmat3(frame.voxels->volume().indexToWorld))) {
  for (const LightDirection& light : frame.directions) whole_ += light.radiance;
}

// Calls visit(entry, enter, leave) for the parts of a ray in bricks and groups of cells that show something, in order,
// until it returns false. @return whether it never did
template <class Visit>
bool ConeMarch::eachStretch(const ValueRay& ray, const Visit& visit) const {
  if (!(ray.enter < ray.leave)) return true;
  constexpr int kGroup = BrickVoxels::kGroup;
  const glm::ivec3 interior = frame_.voxels->volume().layout.interior, groups = frame_.voxels->groups();
  const glm::dvec3 inverse = 1.0 / ray.direction;
  std::array<std::int64_t, 3> first;
  glm::dvec3 low;
  glm::i64vec3 count;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    first[at] = frame_.bricks->cellOf(static_cast<std::int64_t>(std::floor(frame_.visible.min[axis])), axis);
    count[axis] =
        frame_.bricks->cellOf(static_cast<std::int64_t>(std::floor(frame_.visible.max[axis])), axis) - first[at] + 1;
    low[axis] = static_cast<double>(frame_.bricks->firstOf(first[at], axis));
  }
  return walkLattice(
      low, glm::dvec3(interior), count, ray, inverse, ray.enter, ray.leave,
      [&](const glm::i64vec3& cell, double enter, double leave) {
        const PlacedBrick* const entry = frame_.bricks->find({first[0] + cell.x, first[1] + cell.y, first[2] + cell.z});
        if (!entry || !entry->brick) return true;
        if (!entry->brick->voxels) return visit(*entry, enter, leave);
        const glm::dvec3 origin(entry->origin);
        return walkLattice(origin, glm::dvec3(kGroup), groups, ray, inverse, enter, leave,
                           [&](const glm::ivec3& group, double in, double out) {
                             const int number = (group.z * groups.y + group.y) * groups.x + group.x;
                             return !entry->brick->active[static_cast<std::size_t>(number)] || visit(*entry, in, out);
                           });
      });
}

// Returns the value at a point of a brick, in steps of the table.
double ConeMarch::stepsAt(const PlacedBrick& entry, const glm::dvec3& point) const {
  if (!entry.brick->voxels) return frame_.table->stepsOf(static_cast<double>(entry.brick->value.min));
  const BrickLayout& layout = frame_.voxels->volume().layout;
  const glm::dvec3 local = point - glm::dvec3(entry.origin);
  const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(local)), glm::ivec3(0), layout.interior - 1);
  const glm::dvec3 share = glm::clamp(local - glm::dvec3(cell), 0.0, 1.0);
  return frame_.table->stepsOf(valueInCell(*frame_.voxels, *entry.brick, cell + layout.apron, share));
}

double ConeMarch::opticalDepth(const ValueRay& ray, double most) const {
  const glm::dvec3 size = glm::abs(ray.direction);
  const double perUnit = std::max({size.x, size.y, size.z});  // steps of a voxel
  double tau = 0;
  eachStretch(ray, [&](const PlacedBrick& entry, double enter, double leave) {
    const int parts = std::max(1, static_cast<int>(std::ceil((leave - enter) * perUnit - 1e-9)));
    const double part = (leave - enter) / parts;
    double from = stepsAt(entry, ray.at(enter));
    for (int i = 1; i <= parts; ++i) {
      const double to = stepsAt(entry, ray.at(enter + i * part));
      tau += part * meanOf(*frame_.table, from, to).x;
      from = to;
    }
    return tau < most;
  });
  return tau;
}

ConeMarch::Light ConeMarch::lightAt(const glm::dvec3& point) const {
  constexpr double kOpaque = 20;  // exp(-20) is 2e-9
  Light light;
  const glm::dvec3 place(frame_.voxels->volume().indexToWorld * glm::dvec4(point, 1));
  for (const LightDirection& one : frame_.directions) {
    if (frame_.mesh && frame_.mesh->first(place, one.direction, 0)) continue;
    ValueRay ray;
    ray.origin = point;
    ray.direction = toIndex_ * one.direction;
    ray.leave = std::numeric_limits<double>::infinity();
    ray.clip(frame_.lightPlanes);
    light.colour += std::exp(-opticalDepth(ray, kOpaque)) * one.radiance;
  }
  const double power = whole_.r + whole_.g + whole_.b;
  if (power > 0) light.visibility = (light.colour.r + light.colour.g + light.colour.b) / power;
  return light;
}

ConeMarch::Pixel ConeMarch::march(ValueRay ray, double toEnd) {
  ray.leave = std::min(ray.leave, toEnd);
  ray.clip(frame_.planes);
  const double stretch = glm::length(toWorld_ * ray.direction);  // world length per depth
  Pixel pixel;
  eachStretch(ray, [&](const PlacedBrick& entry, double enter, double leave) {
    const int parts = std::max(1, static_cast<int>(std::ceil((leave - enter) / frame_.longest - 1e-9)));
    const double part = (leave - enter) / parts;
    double from = stepsAt(entry, ray.at(enter));
    for (int i = 0; i < parts; ++i) {
      const double begin = enter + i * part, to = stepsAt(entry, ray.at(begin + part));
      const glm::dvec4 medium = meanOf(*frame_.table, from, to);
      from = to;
      ++segments_;
      const double tau = medium.x * part * stretch;
      if (!(tau > 0)) continue;
      const double at = begin + part * static_cast<double>(placeSeen(static_cast<float>(tau))),
                   share = (1 - pixel.opacity) * -std::expm1(-tau);
      const Light light = lightAt(ray.at(at));
      pixel.colour += share / medium.x * glm::dvec3(medium.y, medium.z, medium.w) * light.colour;
      pixel.opacity += share;
      pixel.visibility += share * light.visibility;
      pixel.depth += share * at;
      if (pixel.opacity > 1 - frame_.saturation) return false;
    }
    return true;
  });
  return pixel;
}

}  // namespace umbrick
