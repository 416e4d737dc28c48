// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/emission.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/short_number.h"
#include "umbrick/optics/black_body.h"

namespace umbrick {
namespace {

// Returns a medium whose sigma_s is a radiance.
Medium emitting(const glm::dvec3& radiance) {
  const double most = std::max({radiance.r, radiance.g, radiance.b});
  if (!(most > 0)) return {};
  return {glm::clamp(radiance / most, 0.0, 1.0), most};
}

double brightnessAt(EmissionBrightness brightness, double kelvin) {
  if (brightness == EmissionBrightness::planck) return blackBodyXyz(kelvin).y / blackBodyXyz(kEmissionReference).y;
  const double fade = std::clamp((kelvin - kEmissionDark) / (kEmissionGlow - kEmissionDark), 0.0, 1.0);
  return brightness == EmissionBrightness::constant ? fade : fade * std::pow(kelvin / kEmissionReference, 4);
}

TransferFunction blackBodies(const EmissionSettings& settings) {
  constexpr int kTemperatures = 400;
  std::vector<TransferFunction::Point> points;
  for (int i = 0; i <= kTemperatures; ++i) {
    const double kelvin = kEmissionDark * std::pow(kEmissionHottest / kEmissionDark, double(i) / kTemperatures);
    const double luminance = i == 0 ? 0 : settings.intensity * brightnessAt(settings.brightness, kelvin);
    // What is darker keeps the colour, so that colours between two points are those of black bodies.
    Medium medium = emitting(blackBodyColour(kelvin));
    medium.sigma_t *= luminance;
    points.push_back({(kelvin - settings.offset) / settings.scale, medium});
  }
  return TransferFunction(std::move(points));
}

TransferFunction lookedUp(const EmissionSettings& settings) {
  if (!settings.table) throw InvalidArgument("emission.kind: table needs emission.transfer, which is missing");
  if (settings.table->is2d())
    throw InvalidArgument("emission.transfer: is a function of value and gradient, must be one of the value alone");
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < settings.table->values().size(); ++i) {
    Medium medium = settings.table->media()[i];
    medium.sigma_t *= settings.intensity;
    points.push_back({(settings.table->values()[i] - settings.offset) / settings.scale, medium});
  }
  return TransferFunction(std::move(points));
}

}  // namespace

TransferFunction emissionFunction(const EmissionSettings& settings) {
  return settings.kind == EmissionKind::table ? lookedUp(settings) : blackBodies(settings);
}

void requireDarkBackground(const TransferFunction& emitted, double background) {
  const double radiance = emitted(background).sigma_t;
  if (radiance > 0)
    throw InvalidArgument("emission: the background of its grid, " + shortNumber(background, 6) +
                          ", would glow everywhere, by " + shortNumber(radiance, 3) +
                          " per world unit; it must be dark: see emission.scale and emission.offset");
}

}  // namespace umbrick
