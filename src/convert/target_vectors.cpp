// SPDX-License-Identifier: Apache-2.0
#include "convert/target_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <string_view>
#include <utility>

#include "convert/target_place.h"
#include "convert/value_loss.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/change_values.h"
#include "umbrick/grid/grid_world.h"

namespace umbrick {
namespace {

using openvdb::StringMetadata;
using openvdb::Vec3f;
using openvdb::Vec3SGrid;

Vec3f asHalf(const Vec3f& v) {
  const auto half = [](float number) { return static_cast<float>(openvdb::math::half(number)); };
  return {half(v[0]), half(v[1]), half(v[2])};
}

Vec3f multiplied(const glm::dmat3& m, double scale, const Vec3f& v) {
  const glm::dvec3 out = m * glm::dvec3(v[0], v[1], v[2]) * scale;
  return {static_cast<float>(out.x), static_cast<float>(out.y), static_cast<float>(out.z)};
}

Vec3f toTarget(const VectorMap& map, const Vec3f& vector) {
  const Vec3f stored = multiplied(map.turn, map.scale, vector);
  return map.half ? asHalf(stored) : stored;
}

Vec3f fromTarget(const VectorMap& map, const Vec3f& background, const Vec3f& stored) {
  if (stored == background) return map.background;
  return multiplied(glm::transpose(map.turn), 1 / map.scale, stored);
}

// A unit of values whose first word is one of length: "mm/s", "m s-1" or "um".
struct LengthUnit {
  double metres = 0;
  std::string rest;  // "/s"
};

// Whether a unit of values goes on with a time behind its length: "/s", " s-1", ".s^-1".
bool isPerTime(std::string_view rest) {
  static constexpr std::array<std::string_view, 8> kTimes{"s", "sec", "ms", "us", "min", "h", "frame", "second"};
  const char first = rest.front();
  rest.remove_prefix(1);
  if (first != '/') {
    for (const std::string_view power : {"^-1", "-1"})
      if (rest.ends_with(power)) {
        rest.remove_suffix(power.size());
        return std::find(kTimes.begin(), kTimes.end(), rest) != kTimes.end();
      }
    return false;
  }
  return std::find(kTimes.begin(), kTimes.end(), rest) != kTimes.end();
}

std::optional<LengthUnit> lengthUnitIn(const std::string& unit) {
  const std::size_t end = std::min(unit.find_first_of("/ .*"), unit.size());
  const double metres = metresOf(unit.substr(0, end));
  const std::string rest = unit.substr(end);
  if (metres == 0 || (!rest.empty() && !isPerTime(rest))) return std::nullopt;
  return LengthUnit{metres, rest};
}

std::string valueUnit(const openvdb::GridBase& grid) {
  const auto text = grid.getMetadata<StringMetadata>("value_unit");
  return text ? text->value() : std::string();
}

// Finds by what vectors are multiplied, and adds to a line about it.
// @param map  gets the factor, and whether the vectors may be velocities
void findScale(const TargetPlace& place, const std::string& lengthUnit, Vec3SGrid& grid, VectorMap& map,
               std::string& line) {
  const std::string unit = valueUnit(grid);
  if (unit.empty()) {
    const std::string from = metresOf(lengthUnit) > 0 ? lengthUnit : "the unit of length";
    line += place.scale == 1
                ? " and keep their lengths, since nothing states another unit for them than that of the places"
                : "; nothing states a unit for them, so that they are taken for lengths in " + from +
                      ", per time or not, and multiplied by " + shortNumber(place.scale, 6) + ", which makes them " +
                      place.unit;
    map.scale = place.scale;
    map.velocity = true;
    return;
  }
  const std::optional<LengthUnit> length = lengthUnitIn(unit);
  if (!length) {
    line += " and keep their lengths, in " + unit;
    return;
  }
  double scale = length->metres / place.metresPerUnit;
  if (scale < 1) scale = 1 / std::round(1 / scale);  // units are powers of ten apart
  const std::string now = place.unit + length->rest;
  grid.insertMeta("value_unit", StringMetadata(now));
  line += scale == 1 ? " and keep their lengths, in " + now
                     : "; their lengths are multiplied by " + shortNumber(scale, 6) + ", from " + unit + " to " + now;
  map.scale = scale;
  map.velocity = !length->rest.empty();
}

// Half floats end at 65504.
bool fitsHalf(const Vec3SGrid& grid) {
  constexpr float kMost = 65504;
  for (auto value = grid.cbeginValueOn(); value; ++value)
    for (int k = 0; k < 3; ++k)
      if (std::abs((*value)[k]) > kMost) return false;
  return true;
}

QuantiseError lossBy(const VectorMap& map, const Vec3SGrid& grid) {
  const Vec3f background = toTarget(map, map.background);
  return lossOf(grid.tree(), [&](const Vec3f& vector) {
    const Vec3f back = fromTarget(map, background, toTarget(map, vector));
    ValueLoss lost;
    for (int k = 0; k < 3; ++k) {
      const double one = std::abs(double(vector[k]) - double(back[k]));
      lost.max = std::max(lost.max, one);
      lost.squares += one * one / 3;  // the mean of the numbers of a voxel, of which reports are
    }
    return lost;
  });
}

}  // namespace

VectorMap prepareVectors(const ConvertOptions& options, VoxelMeaning meaning, Vec3SGrid& grid, ConvertedGrid& report) {
  const TargetTraits& target = traitsOf(*options.output.target);
  const std::string lengthUnit = worldOf(grid).lengthUnit;
  const TargetPlace place = placeFor(options.output, /*foreign=*/false, grid, report.notes);
  VectorMap map;
  map.background = grid.background();
  if (meaning == VoxelMeaning::colour) {
    map.half = target.unitValues && fitsHalf(grid);
    if (map.half) {
      grid.setSaveFloatAsHalf(true);
      report.build.storage = "three half floats";
      report.notes.push_back("colours become half floats");
    }
  } else {
    map.turn = place.turn;
    std::string line = map.turn == glm::dmat3(1) ? "vectors keep their directions" : "vectors turn with the axes";
    findScale(place, lengthUnit, grid, map, line);
    report.notes.push_back(line);
    if (map.scale != 1) grid.insertMeta("vector_scale", openvdb::DoubleMetadata(map.scale));
    grid.setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);  // programs that move the grid turn its vectors, too
  }
  addQuantising(report.build, lossBy(map, grid), /*activeOnly=*/false);
  changeValues(grid.tree(), [&](const Vec3f& vector) { return toTarget(map, vector); });
  tellLimits(target, grid, place.scale, /*resamples=*/false, report.notes);
  return map;
}

Vec3SGrid::ConstPtr unmapped(const Vec3SGrid::ConstPtr& grid, const std::optional<VectorMap>& map) {
  if (!map) return grid;
  const auto copy = grid->deepCopy();
  const Vec3f background = grid->background();
  changeValues(copy->tree(), [&](const Vec3f& stored) { return fromTarget(*map, background, stored); });
  return copy;
}

std::vector<std::string> nameVectors(Target target, const std::vector<NamedVectors>& vectors,
                                     const openvdb::GridCPtrVec& all) {
  const TargetTraits& traits = traitsOf(target);
  std::vector<std::string> lines;
  for (const bool colours : {false, true}) {
    const std::string name(colours ? traits.colour : traits.velocity);
    if (std::any_of(all.begin(), all.end(), [&](const auto& grid) { return grid->getName() == name; })) continue;
    const auto found = std::find_if(vectors.begin(), vectors.end(), [&](const NamedVectors& each) {
      return colours ? each.meaning == VoxelMeaning::colour : each.meaning != VoxelMeaning::colour && each.velocity;
    });
    if (found == vectors.end()) continue;
    lines.push_back("grid \"" + found->grid->getName() + "\" is called " + name + ", as " + std::string(traits.name) +
                    " calls " + (colours ? "colours" : "velocities"));
    found->grid->setName(name);
  }
  return lines;
}

}  // namespace umbrick
