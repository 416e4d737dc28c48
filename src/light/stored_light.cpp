// SPDX-License-Identifier: Apache-2.0
#include "light/stored_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>
#include <tuple>

#include "light/sweep_kernels.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr double kMostCode = 65535;

// @param light  in units of codes
std::uint16_t codeOf(float light) {
  return static_cast<std::uint16_t>(std::min(std::max(light, 1.0f), static_cast<float>(kMostCode)) + 0.5f);
}

template <class Work>
void forEachBrick(std::size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

}  // namespace

bool comesBefore(const glm::ivec3& a, const glm::ivec3& b) {
  return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x);
}

std::size_t StoredLight::find(const glm::ivec3& origin) const {
  const auto found = std::lower_bound(origins_.begin(), origins_.end(), origin, comesBefore);
  return found != origins_.end() && *found == origin ? static_cast<std::size_t>(found - origins_.begin())
                                                     : origins_.size();
}

void StoredLight::store(const SweptBricks& bricks, std::vector<glm::ivec3> origins) {
  layout_ = bricks.layout;
  light_ = bricks.light;
  channels_ = bricks.channels;
  origins_ = std::move(origins);
  codes_.assign(origins_.size() * perBrick(), 0);
  // Beyond planes that cut the medium light is more than all that arrives.
  std::int32_t most = static_cast<std::int32_t>(kWholeLight);
  if (!bricks.planes.empty()) most = std::max(most, *std::ranges::max_element(bricks.sums));
  unit_ = static_cast<float>(most / double{kWholeLight} / kMostCode);
  const std::size_t places = light_.places();
  const float perSum = 1 / (kWholeLight * unit_);
  forEachBrick(origins_.size(), [&](std::size_t brick) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
      const std::size_t first = brick * perBrick() + c * places;
      const std::int32_t* const sums = bricks.sums.data() + first;
      std::uint16_t* const codes = codes_.data() + first;
      forEachRow(bricks.lit[brick], light_, [&](const glm::ivec3&, std::size_t place, std::size_t count) {
        for (std::size_t i = place; i < place + count; ++i) codes[i] = codeOf(static_cast<float>(sums[i]) * perSum);
      });
    }
  });
}

void StoredLight::change(const SweptBricks& changed, std::vector<glm::ivec3> origins, const glm::dvec3& scale) {
  const std::size_t places = light_.places(), channels = static_cast<std::size_t>(channels_);
  const float unit = unit_;
  // Calls visit(place, share) for the places of a brick whose light is known after the change.
  const auto forEachShare = [&](std::size_t brick, std::size_t c, const auto& visit) {
    const std::size_t before = find(origins[brick]);
    const std::uint16_t* const from =
        before == origins_.size() ? nullptr : codes_.data() + before * perBrick() + c * places;
    const auto kept = [&](std::size_t place) {
      return from ? from[place] * double{unit} * scale[static_cast<int>(c)] : 0;
    };
    const auto found = std::lower_bound(changed.origins.begin(), changed.origins.end(), origins[brick], comesBefore);
    if (found == changed.origins.end() || *found != origins[brick]) {
      for (std::size_t place = 0; from && place < places; ++place)
        if (from[place] != 0) visit(place, kept(place));
      return;
    }
    const auto swept = static_cast<std::size_t>(found - changed.origins.begin());
    const std::int32_t* const sums = changed.sums.data() + swept * perBrick() + c * places;
    forEachRow(changed.lit[swept], light_, [&](const glm::ivec3&, std::size_t first, std::size_t count) {
      for (std::size_t place = first; place < first + count; ++place)
        visit(place, kept(place) + sums[place] / double{kWholeLight});
    });
  };
  // Where a plane cuts the medium now, there may be more light than before.
  const double most = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, changed.planes.empty() ? 0 : origins.size()), kMostCode * unit,
      [&](const auto& range, double largest) {
        for (std::size_t brick = range.begin(); brick != range.end(); ++brick)
          for (std::size_t c = 0; c < channels; ++c)
            forEachShare(brick, c, [&](std::size_t, double share) { largest = std::max(largest, share); });
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
  unit_ = static_cast<float>(most / kMostCode);
  LargeVector<std::uint16_t> codes(origins.size() * perBrick(), 0);
  forEachBrick(origins.size(), [&](std::size_t brick) {
    for (std::size_t c = 0; c < channels; ++c) {
      std::uint16_t* const to = codes.data() + brick * perBrick() + c * places;
      forEachShare(brick, c, [&](std::size_t place, double share) {
        to[place] = codeOf(static_cast<float>(share / double{unit_}));
      });
    }
  });
  origins_ = std::move(origins);
  codes_ = std::move(codes);
}

void StoredLight::read(const glm::ivec3& origin, std::span<float> light) const {
  const std::size_t voxels = layout_.voxels(), channels = static_cast<std::size_t>(channels_), places = light_.places();
  if (light.size() != voxels * channels)
    throw InvalidArgument("light: " + std::to_string(light.size()) + " numbers to fill, must be " +
                          std::to_string(voxels * channels));
  const std::size_t brick = find(origin);
  if (brick == origins_.size())
    throw InvalidArgument("light: there is none for the brick at (" + std::to_string(origin.x) + ", " +
                          std::to_string(origin.y) + ", " + std::to_string(origin.z) + ")");
  const glm::ivec3 edge = layout_.edge(), held = light_.edge();
  const std::ptrdiff_t strides[3]{1, held.x, std::ptrdiff_t(held.x) * held.y};
  for (std::size_t c = 0; c < channels; ++c) {
    const std::uint16_t* const from = codes_.data() + brick * perBrick() + c * places;
    float* to = light.data() + c;
    if (light_.spacing == 1) {
      for (std::size_t i = 0; i < voxels; ++i, to += channels) *to = static_cast<float>(from[i]) * unit_;
      continue;
    }
    for (int z = 0; z < edge.z; ++z)
      for (int y = 0; y < edge.y; ++y)
        for (int x = 0; x < edge.x; ++x, to += channels) {
          // Places count from -apron of their own, voxels from that of the brick.
          const glm::ivec3 p = glm::ivec3(x, y, z) - layout_.apron + light_.apron * 2, low = p / 2, odd = p - 2 * low;
          const std::uint16_t* const corner = from + low.x + low.y * strides[1] + low.z * strides[2];
          int sum = 0, known = 0;
          for (int k = 0; k <= odd.z; ++k)
            for (int j = 0; j <= odd.y; ++j)
              for (int i = 0; i <= odd.x; ++i) {
                const int one = corner[i + j * strides[1] + k * strides[2]];
                sum += one;
                known += one != 0;
              }
          *to = known > 0 ? static_cast<float>(sum) / static_cast<float>(known) * unit_ : 0.0f;
        }
  }
}

double StoredLight::spacingError() const {
  if (light_.spacing == 1 || origins_.empty()) return 0;
  // Squares of what the mean of the places `step` before and behind is off, along each axis.
  struct Sums {
    double two = 0, four = 0;
    std::size_t count = 0;
  };
  const glm::ivec3 edge = light_.edge();
  const std::ptrdiff_t strides[3]{1, edge.x, std::ptrdiff_t(edge.x) * edge.y};
  const std::size_t places = light_.places(), channels = static_cast<std::size_t>(channels_);
  const Sums sums = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, origins_.size() * channels), Sums{},
      [&](const auto& range, Sums sum) {
        for (std::size_t block = range.begin(); block != range.end(); ++block)
          for (int axis = 0; axis < 3; ++axis)
            for (int z = 0; z < edge.z; ++z)
              for (int y = 0; y < edge.y; ++y)
                for (int x = 0; x < edge.x; ++x) {
                  const int at = glm::ivec3(x, y, z)[axis];
                  if (at < 2 || at + 2 >= edge[axis]) continue;
                  const std::uint16_t* const place =
                      codes_.data() + block * places + x + y * strides[1] + z * strides[2];
                  const auto one = [&](int step) { return static_cast<double>(place[step * strides[axis]]); };
                  if (one(-2) == 0 || one(-1) == 0 || one(0) == 0 || one(1) == 0 || one(2) == 0) continue;
                  const double two = one(0) - 0.5 * (one(-1) + one(1)), four = one(0) - 0.5 * (one(-2) + one(2));
                  sum.two += two * two;
                  sum.four += four * four;
                  ++sum.count;
                }
        return sum;
      },
      [](const Sums& a, const Sums& b) {
        return Sums{a.two + b.two, a.four + b.four, a.count + b.count};
      });
  if (sums.count == 0 || sums.two == 0) return 0;
  const double two = std::sqrt(sums.two / static_cast<double>(sums.count));
  const double factor = std::clamp(std::sqrt(sums.four / sums.two), 1.0, 4.0);
  // Half-way along one axis light is off by two / factor. Between four paths that are as far apart as places it is off
  // by 2/3 of that along each of two axes, for shares of the way that are spread evenly; and of the voxels, half lie
  // half-way between places along each of three. Light falls off like an exponential, so that these errors mostly have
  // one sign.
  constexpr double kWays = 2 * (2.0 / 3) + 3 * 0.5;
  return kWays * two / factor * double{unit_};
}

}  // namespace umbrick
