// SPDX-License-Identifier: Apache-2.0
#include "check/picture_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/result.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {
namespace {

// Raises the largest difference to a value. A difference that is not a number counts as the largest of all.
void raise(double& largest, double value) {
  if (!(value <= largest)) largest = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

// Returns the unit in the last place of a buffer whose values are below 1: one rounding is off by half of it.
double lastPlace(int bits) { return bits == 16 ? 0x1p-11 : 0x1p-24; }

}  // namespace

PictureDifference difference(const Picture& a, const Picture& b, const ResolvedScene& scene, double farthest) {
  PictureDifference result;
  const double ambient = std::max({scene.ambient.r, scene.ambient.g, scene.ambient.b, 1e-30});
  for (std::size_t i = 0; i < a.visibility.pixels.size(); ++i) {
    const float *colourA = &a.colour.pixels[4 * i], *colourB = &b.colour.pixels[4 * i];
    for (std::size_t c = 0; c < 3; ++c) raise(result.colour, std::abs(double(colourA[c]) - colourB[c]) / ambient);
    raise(result.colour, std::abs(double(colourA[3]) - colourB[3]));
    raise(result.visibility, std::abs(double(a.visibility.pixels[i]) - b.visibility.pixels[i]));
    const double opacity = std::min(colourA[3], colourB[3]);
    if (opacity > 0) raise(result.depth, opacity * std::abs(double(a.depth.pixels[i]) - b.depth.pixels[i]) / farthest);
  }
  return result;
}

PictureLimit pictureLimit(const PictureDifference& shifted, const ResolvedScene& scene, std::int64_t slices) {
  // Each slab adds a product and rounds twice, in each of two pictures. The occlusion buffer or the light windows
  // do the same.
  const auto n = static_cast<double>(slices);
  double sums = 2 * n * lastPlace(scene.sampling.bits);
  if (occlusionMethod(scene)) sums += 2 * n * lastPlace(scene.occlusion.bits);
  PictureLimit limit;
  // All samples were displaced by the most that rounding can do, and all in one direction; in the other picture it may
  // be the opposite one.
  limit.rounding = {2 * shifted.colour + sums, 2 * shifted.visibility + sums, 2 * shifted.depth + 2 * sums};
  // Beyond four deviations of a random walk lies 3.2e-5 of the light, on each of four sides. Ordinates leave
  // no light out.
  if (occlusionMethod(scene) == Method::dos) limit.light = 4 * 3.2e-5;
  return limit;
}

LayerShare worstLayer(const PictureDifference& difference, const PictureLimit& limit, double extra) {
  LayerShare worst{difference.colour, limit.rounding.colour + limit.light + extra, "colour"};
  for (const LayerShare& layer :
       {LayerShare{difference.visibility, limit.rounding.visibility + limit.light + extra, "V"},
        LayerShare{difference.depth, limit.rounding.depth + limit.light + extra, "depth"}})
    if (shareOfLimit(layer.value, layer.limit) > shareOfLimit(worst.value, worst.limit)) worst = layer;
  return worst;
}

double seamExcess(const Picture& bricked, const Picture& other, const ResolvedScene& scene, const Bricks& bricks,
                  std::size_t& pairs) {
  const IndexView view = indexView(scene.camera, bricks.indexToWorld);
  const ScreenPlane screen = screenPlane(scene.camera);
  const Image &a = bricked.visibility, &b = other.visibility;
  const auto cell = [&](int x, int y, int axis) {
    const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * screen.pixelSize - screen.halfExtent;
    const double index = view.eyeIndex[axis] + p.x * view.toIndex[0][axis] + p.y * view.toIndex[1][axis];
    return std::floor((index + 0.5) / bricks.layout.interior[axis]);
  };
  double worst = 0;
  const auto compare = [&](int x0, int y0, int x1, int y1) {
    if (x1 >= a.width || y1 >= a.height) return;
    if (cell(x0, y0, 0) == cell(x1, y1, 0) && cell(x0, y0, 2) == cell(x1, y1, 2)) return;
    ++pairs;
    const double stepA = std::abs(double(*a.at(x1, y1)) - *a.at(x0, y0));
    const double stepB = std::abs(double(*b.at(x1, y1)) - *b.at(x0, y0));
    raise(worst, stepA - stepB);
  };
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      compare(x, y, x + 1, y);
      compare(x, y, x, y + 1);
    }
  return worst;
}

}  // namespace umbrick
