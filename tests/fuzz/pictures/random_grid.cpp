// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pictures/random_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <vector>

#include "fuzz/pictures/short_number.h"
#include "support/test_grids.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {
using openvdb::Coord;

// Content from 0, the background, to 1, with what is active. Labels are at whole parts of 1.
struct Content {
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  double thickness = 8, levels = 0;
  std::string name;
};

// Sets voxels of the box where the field is not 0.
void fill(Content& content, const glm::ivec3& low, const glm::ivec3& high,
          const std::function<double(const glm::dvec3&)>& field, bool zerosToo = false) {
  openvdb::FloatGrid::Accessor accessor = content.grid->getAccessor();
  for (int x = low.x; x <= high.x; ++x)
    for (int y = low.y; y <= high.y; ++y)
      for (int z = low.z; z <= high.z; ++z) {
        const auto value = static_cast<float>(field(glm::dvec3(x, y, z)));
        if (zerosToo || value != 0) accessor.setValue(Coord(x, y, z), value);
      }
}

Content blobs(Dice& dice) {
  Content content;
  const int count = dice.whole(1, 5), power = dice.whole(1, 2);
  const double reach = dice.between(6, 16);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 centre = dice.point(glm::dvec3(-reach), glm::dvec3(reach));
    const double radius = dice.between(2.5, 9), peak = dice.between(0.4, 1);
    openvdb::FloatGrid::Accessor accessor = content.grid->getAccessor();
    const glm::ivec3 low(glm::floor(centre - radius)), high(glm::ceil(centre + radius));
    fill(content, low, high, [&](const glm::dvec3& p) {
      const double inside = std::max(0.0, 1 - glm::length(p - centre) / radius);
      const float before = accessor.getValue(Coord(int(p.x), int(p.y), int(p.z)));
      return std::max<double>(before, peak * std::pow(inside, power));
    });
  }
  content.thickness = 7;
  content.name = std::to_string(count) + " blobs";
  return content;
}

Content shell(Dice& dice) {
  Content content;
  const glm::dvec3 centre = dice.point(glm::dvec3(-3), glm::dvec3(3));
  const double radius = dice.between(4, 16), width = dice.between(0.8, 3);
  const bool filled = dice.chance(0.3);
  const glm::ivec3 low(glm::floor(centre - radius - width)), high(glm::ceil(centre + radius + width));
  fill(content, low, high, [&](const glm::dvec3& p) {
    const double beyond = glm::length(p - centre) - radius;
    return filled && beyond < 0 ? 1 : std::max(0.0, 1 - std::abs(beyond) / width);
  });
  content.thickness = filled ? radius : 2 * width;
  content.name = filled ? "ball" : "shell";
  return content;
}

// Nothing but the sheets is active, so that what they show lies at the very border of the active voxels.
Content sheets(Dice& dice) {
  Content content;
  const SmoothField field(static_cast<unsigned>(dice.below(1000)));
  const bool flat = dice.chance(0.5);
  const int count = dice.chance(0.3) ? 2 : 1, voxels = dice.whole(1, 3);
  for (int i = 0; i < count; ++i) {
    const int axis = dice.below(3), at = dice.whole(-24, 47);
    glm::ivec3 low, high;
    for (int side = 0; side < 3; ++side) {
      low[side] = dice.whole(-8, 12);
      high[side] = low[side] + dice.whole(6, 30);
    }
    low[axis] = at;
    high[axis] = at + voxels - 1;
    const double peak = dice.between(0.5, 1);
    fill(content, low, high, [&](const glm::dvec3& p) { return flat ? peak : peak * (0.3 + 0.7 * field(p)); });
    content.name += (i > 0 ? " and " : "sheet ") + std::string("xyz"[axis] + std::string("=") + std::to_string(at));
  }
  content.name += " of " + std::to_string(voxels);
  content.thickness = voxels;
  return content;
}

Content voxels(Dice& dice) {
  Content content;
  const int count = dice.chance(0.5) ? 1 : dice.whole(2, 7);
  for (int i = 0; i < count; ++i) {
    const glm::ivec3 at(dice.point(glm::dvec3(-10), glm::dvec3(30)));
    content.grid->tree().setValue(Coord(at.x, at.y, at.z), static_cast<float>(i == 0 ? 1 : dice.between(0.3, 1)));
  }
  content.thickness = 1;
  content.name = count == 1 ? "one voxel" : std::to_string(count) + " voxels";
  return content;
}

Content tiles(Dice& dice) {
  Content content;
  const int count = dice.whole(1, 5);
  for (int i = 0; i < count; ++i) {
    const glm::ivec3 at = 8 * glm::ivec3(glm::floor(dice.point(glm::dvec3(-2), glm::dvec3(4))));
    content.grid->tree().addTile(1, Coord(at.x, at.y, at.z), static_cast<float>(i == 0 ? 1 : dice.between(0.2, 1)),
                                 dice.chance(0.7));
  }
  content.name = std::to_string(count) + " tiles";
  content.thickness = 8;
  if (dice.chance(0.3)) {
    content.grid->tree().setValue(Coord(dice.whole(-20, 40), dice.whole(-20, 40), dice.whole(-20, 40)), 0.8f);
    content.name += " and a voxel";
  }
  return content;
}

// Regions around random points, each of one label.
Content labels(Dice& dice) {
  Content content;
  const glm::dvec3 extent = dice.point(glm::dvec3(8), glm::dvec3(30));
  content.levels = dice.whole(2, 5);
  std::vector<std::pair<glm::dvec3, double>> seeds;
  for (int i = dice.whole(4, 9); i > 0; --i)
    seeds.push_back({dice.point(glm::dvec3(0), extent), dice.whole(0, static_cast<int>(content.levels))});
  seeds.front().second = content.levels;
  fill(content, glm::ivec3(0), glm::ivec3(extent), [&](const glm::dvec3& p) {
    const auto nearest = std::min_element(seeds.begin(), seeds.end(), [&](const auto& a, const auto& b) {
      return glm::distance(a.first, p) < glm::distance(b.first, p);
    });
    return nearest->second / content.levels;
  });
  content.name = shortNumber(content.levels) + " labels";
  return content;
}

// A narrow band of signed distance, turned so that the outside is 0 and the inside, which is not active, is 1.
Content levelSet(Dice& dice) {
  Content content;
  const glm::dvec3 centre = dice.point(glm::dvec3(-4), glm::dvec3(4));
  const double radius = dice.between(5, 15), waves = dice.between(0, 2);
  const auto inside = [&](const glm::dvec3& p) {
    const double distance = radius + waves * std::sin(0.5 * p.x) * std::cos(0.4 * p.y) - glm::length(p - centre);
    return std::clamp(0.5 + distance / 6, 0.0, 1.0);
  };
  const glm::ivec3 low(glm::floor(centre - radius - 6.0)), high(glm::ceil(centre + radius + 6.0));
  fill(content, low, high, inside);
  for (auto voxel = content.grid->beginValueOn(); voxel; ++voxel)
    if (*voxel == 1) voxel.setValueOff();
  content.grid->pruneGrid();
  content.thickness = 1.5 * radius;
  content.name = "level set";
  return content;
}

// Nothing fades: the faces of the box cut the field off.
Content block(Dice& dice) {
  Content content;
  const glm::ivec3 extent(dice.point(glm::dvec3(3), glm::dvec3(34)));
  const SmoothField field(static_cast<unsigned>(dice.below(1000)));
  const bool noise = dice.chance(0.25), slope = !noise && dice.chance(0.3);
  fill(content, glm::ivec3(0), extent, [&](const glm::dvec3& p) {
    return noise ? dice.uniform() : slope ? (p.x + p.y + 1) / (extent.x + extent.y + 1) : field(p);
  });
  content.thickness = std::min({extent.x, extent.y, extent.z}) + 1;
  content.name = noise ? "noise" : slope ? "slope" : "block";
  return content;
}

Content apart(Dice& dice) {
  Content content;
  const glm::dvec3 gap = dice.between(30, 90) * dice.direction();
  const glm::dvec3 centres[]{glm::dvec3(0), gap};
  for (const glm::dvec3& centre : centres) {
    const double radius = dice.between(3, 8);
    fill(content, glm::ivec3(glm::floor(centre - radius)), glm::ivec3(glm::ceil(centre + radius)),
         [&](const glm::dvec3& p) { return std::max(0.0, 1 - glm::length(p - centre) / radius); });
  }
  content.thickness = 6;
  content.name = "two bodies " + shortNumber(glm::length(gap)) + " apart";
  return content;
}

Content randomContent(Dice& dice) {
  switch (dice.below(10)) {
    case 0:
      return shell(dice);
    case 1:
    case 2:
      return sheets(dice);
    case 3:
      return voxels(dice);
    case 4:
      return tiles(dice);
    case 5:
      return labels(dice);
    case 6:
      return levelSet(dice);
    case 7:
      return block(dice);
    case 8:
      return apart(dice);
    default:
      return blobs(dice);
  }
}

// What becomes of content and background.
struct Values {
  double offset = 0, scale = 1;
  std::string name;
};

Values randomValues(Dice& dice, double levels) {
  Values values;
  if (levels > 0) {
    values.scale = levels;
    values.offset = dice.chance(0.2) ? dice.of({1.0, -2.0, 100.0}) : 0;
  } else if (dice.chance(0.5)) {
    values.scale = dice.chance(0.2) ? -1 : 1;
    switch (dice.below(5)) {
      case 0:
        values.offset = dice.of({273.15, 101325.0, -1000.0, -0.5});
        break;
      case 1:
        values.scale *= dice.scaleBetween(1e-6, 1e6);
        break;
      case 2:
        values.scale *= dice.of({6.0, 100.0, 4095.0});
        values.offset = dice.between(-1, 0) * std::abs(values.scale);
        break;
      default:
        break;
    }
  }
  if (values.scale != 1 || values.offset != 0)
    values.name = ", values " + shortNumber(values.offset) + " + " + shortNumber(values.scale) + " v";
  return values;
}

// The same voxels and tiles with other values, at other indices. A tile whose place is no longer that of a node becomes
// voxels.
openvdb::FloatGrid::Ptr changed(const openvdb::FloatGrid& grid, const std::function<float(float)>& map,
                                const glm::ivec3& shift = glm::ivec3(0)) {
  const float background = grid.background();
  openvdb::FloatGrid::Ptr result = openvdb::FloatGrid::create(map(background));
  openvdb::FloatTree& tree = result->tree();
  for (auto value = grid.cbeginValueAll(); value; ++value) {
    const bool on = value.isValueOn();
    if (!on && *value == background) continue;
    const float mapped = map(*value);
    openvdb::CoordBBox box;
    value.getBoundingBox(box);
    box.translate(Coord(shift.x, shift.y, shift.z));
    if (!value.isVoxelValue() && shift == glm::ivec3(0)) {
      tree.addTile(value.getLevel(), box.min(), mapped, on);
    } else if (on) {
      tree.denseFill(box, mapped, true);
    } else {
      for (auto voxel = box.begin(); voxel; ++voxel) tree.setValueOff(*voxel, mapped);
    }
  }
  return result;
}

// Turned, of unequal axes, sheared or mirrored, as the dice fall; the shortest axis has length `edge`.
glm::dmat4 crooked(Dice& dice, double edge) {
  glm::dmat4 matrix = glm::rotate(glm::dmat4(1), dice.between(0, 6.28), dice.direction());
  if (dice.chance(0.6)) matrix = glm::scale(matrix, dice.point(glm::dvec3(1), glm::dvec3(dice.chance(0.15) ? 20 : 3)));
  if (dice.chance(0.3)) matrix[2] += dice.between(-0.5, 0.5) * matrix[0];
  if (dice.chance(0.4)) matrix[static_cast<glm::length_t>(dice.below(3))] *= -1.0;
  const double shortest = std::min({glm::length(matrix[0]), glm::length(matrix[1]), glm::length(matrix[2])});
  for (glm::length_t axis = 0; axis < 3; ++axis) matrix[axis] *= edge / shortest;
  return matrix;
}

glm::dmat4 randomTransform(Dice& dice, std::string& name) {
  const double edge = dice.chance(0.6) ? 1 : dice.scaleBetween(1e-3, 1e3);
  glm::dmat4 matrix = glm::dmat4(glm::dmat3(edge));
  if (dice.chance(0.4)) {
    matrix = crooked(dice, edge);
    name += ", crooked";
  }
  if (edge != 1) name += ", voxels of " + shortNumber(edge);
  if (dice.chance(0.3)) {
    const double distance = edge * dice.scaleBetween(10, 1e5);
    matrix[3] = glm::dvec4(distance * dice.direction(), 1);
    name += ", " + shortNumber(distance / edge) + " voxels from the origin";
  }
  return matrix;
}

}  // namespace

RandomGrid randomGrid(Dice& dice) {
  RandomGrid result;
  Content content = randomContent(dice);
  result.description = content.name;
  // A border of active voxels that hold nothing: else what is seen ends where activity does.
  if (dice.chance(0.2)) {
    const int margin = dice.whole(1, 4);
    openvdb::CoordBBox box = content.grid->evalActiveVoxelBoundingBox();
    box.expand(margin);
    openvdb::FloatGrid::Ptr border = openvdb::FloatGrid::create(0);
    border->denseFill(box, 0, true);
    content.grid->tree().topologyUnion(border->tree());
    result.description += ", border of " + std::to_string(margin);
  }
  const Values values = randomValues(dice, content.levels);
  const bool rounded = content.levels == 0 && std::abs(values.scale) >= 6 && dice.chance(0.4);
  content.grid = changed(*content.grid, [&](float v) {
    const double mapped = values.offset + values.scale * double(v);
    return static_cast<float>(rounded ? std::round(mapped) : mapped);
  });
  result.description += values.name + (rounded ? ", whole" : "");
  result.background = content.grid->background();
  result.full = values.offset + values.scale;
  result.thickness = content.thickness;
  result.levels = content.levels;

  openvdb::CoordBBox box = content.grid->evalActiveVoxelBoundingBox();
  if (box.empty()) {
    // Tiles that are all inactive: what no voxel is active of has no bounds to look at.
    content.grid->tree().setValueOn(Coord(0, 0, 0), static_cast<float>(result.full));
    box = content.grid->evalActiveVoxelBoundingBox();
  }
  const auto somewhere = [&] {
    return Coord(dice.whole(box.min().x(), box.max().x()), dice.whole(box.min().y(), box.max().y()),
                 dice.whole(box.min().z(), box.max().z()));
  };
  if (dice.chance(0.08)) {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (int i = dice.whole(1, 4); i > 0; --i) content.grid->tree().setValueOn(somewhere(), dice.of({nan, infinity}));
    result.description += ", not finite";
  }
  if (dice.chance(0.08)) {
    const double factor = dice.of({10.0, 1000.0, 1e6, -1000.0});
    content.grid->tree().setValueOn(somewhere(), static_cast<float>(values.offset + factor * values.scale));
    result.description += ", outlier " + shortNumber(factor);
  }
  result.value = {result.background, result.background};
  for (auto value = content.grid->cbeginValueAll(); value; ++value)
    if (std::isfinite(*value)) result.value.include(*value);

  std::string place;
  glm::dmat4 transform = randomTransform(dice, place);
  if (dice.chance(0.3)) {
    // The voxels move to other indices. What lies far away there lies near the origin of the world, as often as not.
    const double distance = dice.of({40.0, 5000.0, 1e5, 1e6});
    glm::ivec3 shift(glm::round(distance * dice.direction()));
    if (dice.chance(0.5)) shift.x = -std::abs(shift.x);
    content.grid = changed(
        *content.grid, [](float v) { return v; }, shift);
    if (dice.chance(0.5)) transform = glm::translate(transform, -glm::dvec3(shift));
    place += ", indices from " + shortNumber(shift.x) + " " + shortNumber(shift.y) + " " + shortNumber(shift.z);
  }
  result.grid = withTransform(makeGrid(content.grid), transform);
  result.description += place;
  return result;
}

}  // namespace umbrick
