// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/projection_colour.h"

#include <algorithm>
#include <cmath>

#include "umbrick/core/srgb.h"

namespace umbrick {

glm::dvec4 projectionColour(const TransferFunction& transfer, double value) {
  const Range window = transfer.valueDomain();
  const double low = window.min, extent = static_cast<double>(window.max) - low;
  const double share = extent > 0 ? std::clamp((value - low) / extent, 0.0, 1.0) : value >= low ? 1.0 : 0.0;
  return {transfer(value, 0).albedo * srgbToLinear(share), 1};
}

bool isBackground(const TransferFunction& transfer, double value, double background) {
  const Range window = transfer.valueDomain();
  return std::abs(value - background) <= 1e-6 * (static_cast<double>(window.max) - window.min);
}

glm::dvec4 xrayColour(double through) {
  const double grey = srgbToLinear(std::clamp(1 - through, 0.0, 1.0));
  return {grey, grey, grey, 1};
}

}  // namespace umbrick
