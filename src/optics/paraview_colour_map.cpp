// SPDX-License-Identifier: Apache-2.0
#include "optics/paraview_colour_map.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "optics/colour_space.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

constexpr double kMostOpacity = 0.999;  // what counts as opaque: a medium of 6.9 optical depths per unit distance
constexpr double kLevel = 0.5 / 255;    // pieces of a curve are off by less than half a level of an 8-bit display

// A curve through nodes in ascending order, two at one place for a step. It is linear between nodes and
// constant beyond.
template <typename T>
struct Curve {
  std::vector<std::pair<double, T>> nodes;

  // Returns the limit from below and the value at `x`.
  std::pair<T, T> sides(double x) const {
    const auto before = [](const auto& node, double at) { return node.first < at; };
    const auto after = [](double at, const auto& node) { return at < node.first; };
    const auto first = std::lower_bound(nodes.begin(), nodes.end(), x, before);
    const auto last = std::upper_bound(nodes.begin(), nodes.end(), x, after);
    if (first != last) return {first->second, std::prev(last)->second};
    if (last == nodes.begin()) return {last->second, last->second};
    if (first == nodes.end()) return {nodes.back().second, nodes.back().second};
    const auto& [x1, y1] = *std::prev(first);
    const auto& [x2, y2] = *first;
    const T y = y1 + (y2 - y1) * ((x - x1) / (x2 - x1));
    return {y, y};
  }
};

// Appends pieces of a curve from `x1`, which is there already, to `x2`. Pieces are halved until `close(approximation,
// truth)` holds at places within each. `at` takes [0, 1].
template <typename T, typename At, typename Close>
void appendPieces(Curve<T>& curve, double x1, double x2, const At& at, const Close& close) {
  struct Piece {
    double begin, end;
  };
  constexpr double kShortest = 1.0 / 1024;
  std::vector<Piece> pending;  // the next one is last
  for (int i = 3; i >= 0; --i) pending.push_back({0.25 * i, 0.25 * (i + 1)});
  while (!pending.empty()) {
    const auto [begin, end] = pending.back();
    pending.pop_back();
    const T y1 = at(begin), y2 = at(end);
    bool fine = end - begin <= kShortest;
    if (!fine) {
      fine = true;
      for (const double share : {0.2, 0.4, 0.6, 0.8})
        fine = fine && close(y1 + (y2 - y1) * share, at(begin + (end - begin) * share));
    }
    if (fine) {
      curve.nodes.emplace_back(end < 1 ? x1 + (x2 - x1) * end : x2, y2);
    } else {
      const double middle = 0.5 * (begin + end);
      pending.push_back({middle, end});
      pending.push_back({begin, middle});
    }
  }
}

ColourSpace readColourSpace(const JsonValue& map) {
  const auto name = map.find("ColorSpace");
  if (!name) return ColourSpace::diverging;  // ParaView's default
  static constexpr std::pair<std::string_view, ColourSpace> kSpaces[]{
      {"RGB", ColourSpace::rgb},    {"HSV", ColourSpace::hsv},           {"Lab", ColourSpace::lab},
      {"CIELAB", ColourSpace::lab}, {"Lab/CIEDE2000", ColourSpace::lab}, {"Diverging", ColourSpace::diverging},
      {"Step", ColourSpace::step}};
  const auto space = name->choice<ColourSpace>(kSpaces);
  const auto wrap = map.find("HSVWrap");
  return space == ColourSpace::hsv && wrap && wrap->number() != 0 ? ColourSpace::hsvWrap : space;
}

// Reads "x" of the entry at `item`, which must not descend.
template <typename T>
double readPlace(const JsonValue& item, const std::vector<std::pair<double, T>>& before) {
  if (!before.empty() && item.number() < before.back().first)
    item.failExpected("a value no smaller than that of the point before");
  return item.number();
}

double readShare(const JsonValue& item) {
  return item.number([](double share) { return share >= 0 && share <= 1; }, "a number from 0 to 1");
}

// Reads a list of numbers that come in groups of four.
std::vector<JsonValue> readGroups(const JsonValue& list, const char* group) {
  std::vector<JsonValue> items = list.items();
  if (items.empty() || items.size() % 4 != 0) list.failExpected(std::string("groups of 4 numbers (") + group + ")");
  return items;
}

glm::dvec3 linear(const glm::dvec3& display) {
  return {srgbToLinear(display.r), srgbToLinear(display.g), srgbToLinear(display.b)};
}

Curve<glm::dvec3> readColours(const JsonValue& map) {
  const std::vector<JsonValue> items = readGroups(map.at("RGBPoints"), "value, red, green, blue");
  std::vector<std::pair<double, glm::dvec3>> display;
  for (std::size_t i = 0; i < items.size(); i += 4)
    display.emplace_back(readPlace(items[i], display),
                         glm::dvec3(readShare(items[i + 1]), readShare(items[i + 2]), readShare(items[i + 3])));
  const ColourSpace space = readColourSpace(map);
  const auto close = [](const glm::dvec3& a, const glm::dvec3& b) {
    bool same = true;
    for (int c = 0; c < 3; ++c) same = same && std::abs(linearToSrgb(a[c]) - linearToSrgb(b[c])) < kLevel;
    return same;
  };
  Curve<glm::dvec3> curve;
  curve.nodes.emplace_back(display[0].first, linear(display[0].second));
  for (std::size_t i = 1; i < display.size(); ++i) {
    const auto& [x1, from] = display[i - 1];
    const auto& [x2, to] = display[i];
    if (x1 == x2 || space == ColourSpace::step) {
      curve.nodes.emplace_back(x1, linear(to));
      curve.nodes.emplace_back(x2, linear(to));
    } else {
      const auto at = [&, a = from, b = to](double t) { return linear(mixColours(a, b, t, space)); };
      appendPieces(curve, x1, x2, at, close);
    }
  }
  return curve;
}

// Returns the opacity between two points of a vtkPiecewiseFunction, whose class comment defines midpoint and sharpness:
// the place where the mean is reached, and how much the curve bends there, from linear (0) to a step (1).
double mixOpacities(double from, double to, double t, double midpoint, double sharpness) {
  midpoint = std::clamp(midpoint, 1e-5, 1 - 1e-5);
  double s = t < midpoint ? 0.5 * t / midpoint : 0.5 + 0.5 * (t - midpoint) / (1 - midpoint);
  if (sharpness > 0.99) return s < 0.5 ? from : to;
  if (sharpness < 0.01) return from + (to - from) * s;
  const double power = 1 + 10 * sharpness;
  s = s < 0.5 ? 0.5 * std::pow(2 * s, power) : 1 - 0.5 * std::pow(2 * (1 - s), power);
  // The curve is Hermite's, with flatter ends the sharper it is.
  const double ss = s * s, sss = ss * s, slope = (1 - sharpness) * (to - from);
  const double opacity = (2 * sss - 3 * ss + 1) * from + (-2 * sss + 3 * ss) * to + (2 * sss - 3 * ss + s) * slope;
  return std::clamp(opacity, std::min(from, to), std::max(from, to));
}

struct OpacityPoint {
  double opacity = 0, midpoint = 0.5, sharpness = 0;
};

double extinction(double opacity, double unitDistance) {
  return -std::log1p(-std::min(opacity, kMostOpacity)) / unitDistance;
}

Curve<double> readExtinction(const JsonValue& map, double first, double last) {
  double unitDistance = 1;
  if (const auto unit = map.find("ScalarOpacityUnitDistance"))
    unitDistance = unit->number([](double distance) { return distance > 0; }, "a number > 0");
  std::vector<std::pair<double, OpacityPoint>> points{{first, {0, 0.5, 0}}, {last, {1, 0.5, 0}}};
  if (const auto list = map.find("Points")) {
    points.clear();
    const std::vector<JsonValue> items = readGroups(*list, "value, opacity, midpoint, sharpness");
    for (std::size_t i = 0; i < items.size(); i += 4)
      points.emplace_back(readPlace(items[i], points),
                          OpacityPoint{readShare(items[i + 1]), readShare(items[i + 2]), readShare(items[i + 3])});
  }
  const auto close = [&](double a, double b) {
    return std::abs(std::exp(-a * unitDistance) - std::exp(-b * unitDistance)) < kLevel;
  };
  Curve<double> curve;
  curve.nodes.emplace_back(points[0].first, extinction(points[0].second.opacity, unitDistance));
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [x1, from] = points[i - 1];
    const auto& [x2, to] = points[i];
    // The curve is a step at the midpoint, of which pieces would make a ramp.
    if (from.sharpness > 0.99 && x1 < x2) {
      const double middle = x1 + (x2 - x1) * from.midpoint;
      curve.nodes.emplace_back(middle, extinction(from.opacity, unitDistance));
      curve.nodes.emplace_back(middle, extinction(to.opacity, unitDistance));
    }
    if (from.sharpness > 0.99 || x1 == x2 || from.opacity == to.opacity) {
      curve.nodes.emplace_back(x2, extinction(to.opacity, unitDistance));
    } else {
      const auto at = [&, a = from, b = to](double t) {
        return extinction(mixOpacities(a.opacity, b.opacity, t, a.midpoint, a.sharpness), unitDistance);
      };
      appendPieces(curve, x1, x2, at, close);
    }
  }
  return curve;
}

}  // namespace

// Fields that say nothing about colour or opacity (Creator, NanColor, Name and others) are ParaView's own
// affair and ignored.
TransferFunction readParaViewColourMap(const JsonValue& maps) {
  const std::vector<JsonValue> list = maps.items();
  if (list.size() != 1)
    maps.fail("expected one colour map, found " + std::to_string(list.size()) + ": keep one in the file");
  const JsonValue& map = list[0];
  if (const auto log = map.find("UseLogScale"); log && log->number() != 0)
    log->fail("a logarithmic scale is not supported: export the map with a linear one");
  if (!map.find("RGBPoints")) map.fail("the field 'RGBPoints' is missing: not a ParaView colour map of a number");
  const Curve<glm::dvec3> colours = readColours(map);
  const Curve<double> sigmas = readExtinction(map, colours.nodes.front().first, colours.nodes.back().first);

  std::vector<double> places;
  for (const auto& node : colours.nodes) places.push_back(node.first);
  for (const auto& node : sigmas.nodes) places.push_back(node.first);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<TransferFunction::Point> points;
  for (const double x : places) {
    const auto [colourBelow, colour] = colours.sides(x);
    const auto [sigmaBelow, sigma] = sigmas.sides(x);
    const auto inGamut = [](const glm::dvec3& c) { return glm::clamp(c, 0.0, 1.0); };
    if (colourBelow != colour || sigmaBelow != sigma) points.push_back({x, {inGamut(colourBelow), sigmaBelow}});
    points.push_back({x, {inGamut(colour), sigma}});
  }
  return TransferFunction(std::move(points));
}

}  // namespace umbrick
