// SPDX-License-Identifier: Apache-2.0
#include "sweep/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>

namespace umbrick {
namespace {

// Four floats that compilers keep in one register.
using FourFloats [[gnu::vector_size(16)]] = float;

FourFloats load(const glm::vec4& from) {
  FourFloats four;
  std::memcpy(&four, &from, sizeof four);
  return four;
}
FourFloats lesser(FourFloats a, FourFloats b) { return a < b ? a : b; }
FourFloats greater(FourFloats a, FourFloats b) { return a > b ? a : b; }

std::array<float, 4> cubicWeights(float t) {
  const float s = 1 - t;
  return {-0.5f * t * s * s, 1 + t * t * (1.5f * t - 2.5f), 1 + s * s * (1.5f * s - 2.5f), -0.5f * s * t * t};
}

void warpPixel(const LatticePicture& picture, const glm::dvec2& place, WarpedPixel& pixel) {
  const int i = static_cast<int>(place.x), j = static_cast<int>(place.y);
  const std::uint8_t* filled = picture.filled.data() + j;
  if (!(filled[-1] | filled[0] | filled[1] | filled[2])) return;
  const std::ptrdiff_t stride = picture.stride, first = (j - 1) * stride + (i - 1);
  const glm::vec4* rows = picture.colour.data() + first;
  const auto u = static_cast<float>(place.x - i), v = static_cast<float>(place.y - j);
  const std::array<float, 4> x = cubicWeights(u), y = cubicWeights(v);
  FourFloats sum{0, 0, 0, 0};
  for (std::size_t row = 0; row < 4; ++row, rows += stride)
    sum += y[row] * (x[0] * load(rows[0]) + x[1] * load(rows[1]) + x[2] * load(rows[2]) + x[3] * load(rows[3]));
  const glm::vec4* near = picture.colour.data() + first + stride + 1;
  const FourFloats a = load(near[0]), b = load(near[1]), c = load(near[stride]), d = load(near[stride + 1]);
  sum = greater(sum, lesser(lesser(a, b), lesser(c, d)));
  sum = lesser(sum, greater(greater(a, b), greater(c, d)));
  std::memcpy(&pixel.colour, &sum, sizeof sum);
  if (picture.aux.empty()) return;
  // Weighted sums of light and depth go with opacity and need not be as sharp.
  const glm::vec2* aux = picture.aux.data() + first + stride + 1;
  pixel.aux = glm::mix(glm::mix(aux[0], aux[1], u), glm::mix(aux[stride], aux[stride + 1], u), v);
  const float opacity = glm::mix(glm::mix(a[3], b[3], u), glm::mix(c[3], d[3], u), v);
  pixel.aux *= opacity > 0 ? pixel.colour.w / opacity : 0;
}

}  // namespace

void warpRow(const LatticePicture& picture, const IndexView& view, int y, bool onlyMain,
             std::span<WarpedPixel> pixels) {
  const glm::dvec2 pixel = 2.0 * view.halfExtent / glm::dvec2(view.size);
  const glm::dvec2 first = view.centre - view.halfExtent + pixel * glm::dvec2(0.5, y + 0.5);
  const RayLattice& lattice = picture.lattice;
  const glm::dvec3 begin = lattice.placeOf(first), step = lattice.placeOf(first + glm::dvec2(pixel.x, 0)) - begin;
  const double width = lattice.width - 2, height = lattice.height - 2;
  for (std::size_t x = 0; x < pixels.size(); ++x) {
    const glm::dvec3 at = begin + static_cast<double>(x) * step;
    if (!(at.z > 0)) continue;
    const glm::dvec2 place = glm::dvec2(at) * (1 / at.z);
    if (!(place.x >= 1 && place.y >= 1 && place.x < width && place.y < height)) continue;
    if (onlyMain && !isMain(lattice, first + glm::dvec2(static_cast<double>(x) * pixel.x, 0))) continue;
    warpPixel(picture, place, pixels[x]);
  }
}

}  // namespace umbrick
