// SPDX-License-Identifier: Apache-2.0
#include "reference/value_pixel.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "reference/voxel_gradient.h"
#include "umbrick/core/error.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/optics/projection_colour.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/surface_light.h"

namespace umbrick {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double backgroundOf(const ScalarGrid& grid) {
  const float background = grid.grid->background();
  return std::isfinite(background) ? background : 0;
}

Medium mediumOf(double sigma_t) { return {glm::dvec3(1), sigma_t}; }

// Returns a function that shows just those voxel cells that matter: of projections all but those of nothing but
// background, of surfaces those with one of the values in them.
TransferFunction functionOf(const ScalarGrid& grid, const ResolvedScene& scene) {
  if (!traitsOf(scene.mode).surfaces) {
    const double background = backgroundOf(grid);
    return TransferFunction({{background - 1, mediumOf(1)}, {background, mediumOf(0)}, {background + 1, mediumOf(1)}});
  }
  std::vector<double> values;
  for (const SceneSurface& surface : scene.surfaces) values.push_back(surface.value);
  std::ranges::sort(values);
  double width = 1e-9 * std::max({1.0, std::abs(values.front()), std::abs(values.back())});
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) width = std::min(width, 0.25 * (values[i] - values[i - 1]));
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && values[i] == values[i - 1]) continue;
    points.push_back({values[i] - width, mediumOf(0)});
    points.push_back({values[i], mediumOf(1)});
    points.push_back({values[i] + width, mediumOf(0)});
  }
  return TransferFunction(points);
}

// Projections are taken between voxel centres: without the voxel of background that the domain has around them.
IndexBox boxOf(const ResolvedScene& scene, const IndexBox& domain) {
  if (traitsOf(scene.mode).surfaces || domain.empty()) return domain;
  return {domain.min + 1, domain.max - 1};
}

const ScalarGrid& checked(const ScalarGrid& grid, const ResolvedScene& scene) {
  if (!traitsOf(scene.mode).surfaces) return grid;
  if (scene.surfaces.empty())
    throw InvalidArgument("surfaces: is empty, must be one value or more for the mode " + modeName(scene.mode));
  Range range = surveyValues(grid).value;
  range.include(static_cast<float>(backgroundOf(grid)));
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const double value = scene.surfaces[i].value;
    if (!(value >= range.min && value < range.max))
      throw InvalidArgument("surfaces[" + std::to_string(i) + "].value: " + shortNumber(value, 9) +
                            " has no surface, the volume has values from " + shortNumber(range.min, 9) + " to " +
                            shortNumber(range.max, 9));
  }
  return grid;
}

// Calls visit(value along s in [0, 1], begin, end) for the cells that a ray meets and the field shows, until it returns
// false.
template <class Visit>
void forEachCell(const Field& field, Field::Accessor& accessor, const IndexRay& ray, const Interval& part,
                 const Visit& visit) {
  field.walkBlocks(
      accessor, ray, part, [&](const FieldBlock& block, const glm::dvec3& origin, double begin, double end) {
        if (!block.values) return visit(Cubic{{block.uniform, 0, 0, 0}}, begin, end);
        return walkCells(block, origin, ray, begin, end, [&](const glm::ivec3& cell, double enter, double leave) {
          const glm::dvec3 corner = origin + glm::dvec3(cell);
          return visit(TrilinearCell(block.values, cell).along(ray.at(enter) - corner, ray.at(leave) - corner), enter,
                       leave);
        });
      });
}

}  // namespace

ValueSpace::ValueSpace(const ScalarGrid& grid, const ResolvedScene& scene, bool skipEmpty)
    : grid_(checked(grid, scene)),
      scene_(scene),
      indexToWorld_(grid.indexToWorld()),
      background_(backgroundOf(grid)),
      classifier_(functionOf(grid, scene)),
      field_(grid, classifier_, scene.gradients, skipEmpty),
      rays_(scene.camera, indexToWorld_),
      region_(scene, boxOf(scene, field_.domain()), indexToWorld_, false, 1e-6),
      litRegion_(scene, boxOf(scene, field_.domain()), indexToWorld_,
                 traitsOf(scene.model).behindEye || lightComesFromBehind(scene), 1e-6) {
  if (isShaded(scene)) phong_.emplace(scene);
}

ValueSpace::~ValueSpace() = default;

glm::dvec3 ValueSpace::gradientAt(const glm::dvec3& point) const {
  const auto accessor = grid_.grid->getConstAccessor();
  const glm::dvec3 below = glm::floor(point);
  const openvdb::Coord at(static_cast<int>(below.x), static_cast<int>(below.y), static_cast<int>(below.z));
  const glm::dvec3 gradient = voxelGradient(point - below, scene_.gradients, [&](int i, int j, int k) {
    const float value = accessor.getValue(at.offsetBy(i, j, k));
    return std::isfinite(value) ? static_cast<double>(value) : background_;
  });
  return glm::transpose(glm::inverse(glm::dmat3(indexToWorld_))) * gradient;
}

glm::dvec3 ValueSpace::colourOf(std::size_t surface) const {
  const SceneSurface& one = scene_.surfaces[surface];
  return one.colour ? *one.colour : scene_.transfer(one.value, 0).albedo;
}

glm::dvec3 ValueSpace::shaded(const glm::dvec3& colour, const glm::dvec3& normal, const glm::dvec3& viewer,
                              const glm::dvec3& share, const glm::dvec3& whole) const {
  if (!phong_) return scene_.ambient * colour * (share * whole);
  return scene_.ambient * (phong_->ambient() * colour + share * phong_->direct(colour, normal, viewer));
}

void ValueMean::add(const ValueResult& sample) {
  ++samples_;
  sum_.colour += sample.colour;
  sum_.depth += sample.depth;
  sum_.visibility += sample.visibility;
  if (std::isnan(sample.value)) return;
  ++numbers_;
  sum_.value += sample.value;
  sum_.position += sample.position;
  sum_.normal += sample.normal;
}

ValueResult ValueMean::result() const {
  ValueResult mean = sum_;
  mean.colour /= samples_;
  mean.depth /= samples_;
  mean.visibility /= samples_;
  const double share = numbers_ > 0 ? 1 / numbers_ : kNone;
  mean.value *= share;
  mean.position *= share;
  mean.normal *= share;
  return mean;
}

void layOverMesh(const MeshEnd& end, const EyeRays::Ray& ray, const glm::dvec3& ambient, ValueResult& result) {
  const double through = 1 - result.colour.w;
  result.colour += through * glm::dvec4(ambient * end.reflected, 1);
  result.visibility += through;
  result.depth += through * end.t * ray.depthPerLength;
}

ValuePixel::ValuePixel(const ValueSpace& space, const std::vector<glm::dvec2>& places, const MeshEnds* mesh)
    : space_(space), places_(places), mesh_(mesh), accessor_(space.field().accessor()) {}

std::optional<ValueResult> ValuePixel::integrate(int x, int y, QuadraturePixel* light) {
  const bool surfaces = traitsOf(space_.scene().mode).surfaces;
  ValueMean mean;
  for (const glm::dvec2& place : places_) {
    const EyeRays::Ray ray = space_.rays().through(x, y, place);
    const std::optional<MeshEnd> end = mesh_ ? mesh_->find(ray) : std::nullopt;
    std::optional<ValueResult> found = surfaces ? meet(ray, endOf(end), light) : project(ray, endOf(end));
    if (!found) return std::nullopt;
    if (end) layOverMesh(*end, ray, space_.scene().ambient, *found);
    mean.add(*found);
  }
  return mean.result();
}

// The extremes of a cubic are at its ends and where it turns, and its mean is exact.
ValueResult ValuePixel::project(const EyeRays::Ray& ray, double last) {
  ++counts_.eyeRays;
  const ResolvedScene& scene = space_.scene();
  const double background = space_.background();
  Interval part = space_.region().clip(ray.index, 0);
  part.end = std::min(part.end, last);
  ValueResult result;
  result.value = background;
  if (part.empty()) return result;
  double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0, met = 0;
  forEachCell(space_.field(), accessor_, ray.index, part, [&](const Cubic& value, double begin, double end) {
    ++counts_.cells;
    std::array<double, 2> turns{};
    const int count = value.turns(turns);
    const auto include = [&](double s) {
      least = std::min(least, value(s));
      most = std::max(most, value(s));
    };
    include(0);
    include(1);
    for (int i = 0; i < count; ++i) include(turns[static_cast<std::size_t>(i)]);
    sum += (end - begin) * (value.integral(0, 1) - background);
    met += end - begin;
    return true;
  });
  const double length = part.end - part.begin;
  if (met < length - 1e-7 * ray.index.perVoxel) {
    least = std::min(least, background);
    most = std::max(most, background);
  }
  result.value = scene.mode == Mode::mip ? most : scene.mode == Mode::minip ? least : background + sum / length;
  if (!isBackground(scene.transfer, result.value, background))
    result.colour = projectionColour(scene.transfer, result.value);
  return result;
}

// Returns what is left of light once it has crossed the surfaces along a ray. A function of value and gradient has
// none that keep light away.
double ValuePixel::throughSurfaces(const IndexRay& ray) {
  const ResolvedScene& scene = space_.scene();
  const Interval part = space_.litRegion().clip(ray, 0);
  double through = 1;
  if (part.empty() || scene.transfer.is2d()) return through;
  std::vector<int> sides(scene.surfaces.size(), 0);
  forEachCell(space_.field(), accessor_, ray, part, [&](const Cubic& value, double, double) {
    ++counts_.cells;
    std::array<double, 2> turns{};
    const int parts = value.turns(turns) + 1;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const double iso = scene.surfaces[k].value;
      if (sides[k] == 0) sides[k] = value(0) > iso ? 1 : -1;
      for (int i = 0; i < parts; ++i) {
        const int side = value(i + 1 < parts ? turns[static_cast<std::size_t>(i)] : 1) > iso ? 1 : -1;
        if (side != sides[k]) through *= 1 - scene.surfaces[k].opacity;
        sides[k] = side;
      }
    }
    return through > 0;
  });
  return through;
}

std::optional<ValueResult> ValuePixel::meet(const EyeRays::Ray& ray, double last, QuadraturePixel* light) {
  ++counts_.eyeRays;
  const ResolvedScene& scene = space_.scene();
  const bool firstOnly = scene.mode == Mode::hybrid;
  Interval part = space_.region().clip(ray.index, 0);
  part.end = std::min(part.end, last);
  ValueResult result;
  result.value = kNone;
  if (part.empty()) return result;
  struct Crossing {
    double t;
    std::size_t surface;
  };
  std::vector<Crossing> crossings;
  std::vector<int> sides(scene.surfaces.size(), 0);  // -1 below, 1 above
  bool stopped = false;
  const auto add = [&](const Crossing& crossing) {
    const glm::dvec3 point = ray.index.at(crossing.t);
    const glm::dvec3 gradient = space_.gradientAt(point), viewer = -ray.direction;
    const double length = glm::length(gradient);
    glm::dvec3 normal = length > 0 ? gradient / length : viewer;
    if (glm::dot(normal, viewer) < 0) normal = -normal;
    const double share = (1 - result.colour.w) * scene.surfaces[crossing.surface].opacity;
    if (firstOnly) result.first = crossing.t;
    if (result.colour.w == 0 && (share > 0 || firstOnly)) {
      result.value = scene.surfaces[crossing.surface].value;
      result.position = space_.worldOf(point);
      result.normal = normal;
    }
    QuadraturePixel::Share arriving;
    if (light) {
      const auto lit = light->shareAt(ray, point + towardsLight(space_.toIndex(), normal),
                                      [&](const IndexRay& towards) { return throughSurfaces(towards); });
      stopped = stopped || !lit;
      arriving = lit.value_or(arriving);
    }
    const glm::dvec3 whole = light ? light->whole() : glm::dvec3(1);
    const glm::dvec3 colour = space_.shaded(space_.colourOf(crossing.surface), normal, viewer, arriving.colour, whole);
    result.colour += share * glm::dvec4(colour, 1);
    result.visibility += share * arriving.visibility;
    result.depth += share * crossing.t * ray.depthPerLength;
  };
  forEachCell(space_.field(), accessor_, ray.index, part, [&](const Cubic& value, double begin, double end) {
    ++counts_.cells;
    crossings.clear();
    std::array<double, 2> turns{};
    const int parts = value.turns(turns) + 1;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const double iso = scene.surfaces[k].value;
      if (sides[k] == 0) sides[k] = value(0) > iso ? 1 : -1;
      double from = 0;
      for (int i = 0; i < parts; ++i) {
        const double to = i + 1 < parts ? turns[static_cast<std::size_t>(i)] : 1;
        const int side = value(to) > iso ? 1 : -1;
        // Where rounding at the face of a cell has put its begin on the other side, the crossing is there.
        if (side != sides[k])
          crossings.push_back(
              {begin + (end - begin) * ((value(from) > iso ? 1 : -1) == side ? from : value.solve(iso, from, to)), k});
        sides[k] = side;
        from = to;
      }
    }
    std::ranges::sort(crossings, {}, &Crossing::t);
    for (const Crossing& crossing : crossings) {
      add(crossing);
      if (stopped || firstOnly || result.colour.w >= 1 - scene.sampling.saturation) return false;
    }
    return true;
  });
  if (stopped) return std::nullopt;
  return result;
}

}  // namespace umbrick
