// Random transfer functions for properties that must hold for all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <random>
#include <vector>

#include "umbrick/optics/transfer_function.h"

namespace umbrick {

inline float uniform(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

inline Medium randomMedium(std::mt19937& random) {
  const float u = uniform(random, 0, 1), v = uniform(random, 0, 1), w = uniform(random, 0, 1);
  // Half of the media are transparent, so that there is something to cull.
  return {{u, v, w}, uniform(random, 0, 1) < 0.5f ? 0.0 : uniform(random, 0, 5)};
}

/// Values in [0, 100], among them steps and peaks narrower than a bin of any table.
inline std::vector<double> randomAxis(std::mt19937& random, int nodes) {
  std::vector<double> axis;
  for (int i = 0; i < nodes; ++i) {
    const float kind = uniform(random, 0, 1);
    const bool nearLast = !axis.empty() && kind < 0.4f;
    axis.push_back(nearLast ? axis.back() + (kind < 0.2f ? 0.0 : 0.01) : uniform(random, 0, 100));
  }
  std::sort(axis.begin(), axis.end());
  return axis;
}

inline TransferFunction randomTransferFunction(std::mt19937& random, int nodes) {
  std::vector<TransferFunction::Point> points;
  for (const double value : randomAxis(random, nodes)) points.push_back({value, randomMedium(random)});
  return TransferFunction(points);
}

inline TransferFunction randomTransferFunction2d(std::mt19937& random, int nodes) {
  std::vector<Medium> media;
  for (int i = 0; i < nodes * nodes; ++i) media.push_back(randomMedium(random));
  std::vector<double> values = randomAxis(random, nodes);
  return TransferFunction(values, randomAxis(random, nodes), media);
}

}  // namespace umbrick
