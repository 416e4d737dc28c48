// Light that a second grid of the volume gives off: fire.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "umbrick/core/names.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

enum class EmissionKind {
  blackBody,  // values are temperatures
  table,      // values are looked up in a function
};
inline constexpr Name<EmissionKind> kEmissionKinds[]{{"blackbody", EmissionKind::blackBody},
                                                     {"table", EmissionKind::table}};

/// How much brighter a black body is the hotter it is.
enum class EmissionBrightness {
  stefanBoltzmann,  // by the fourth power of the temperature, as all of its radiation is
  planck,           // as what is visible of it: the luminance of blackBodyXyz()
  constant,         // not at all: colours alone
};
inline constexpr Name<EmissionBrightness> kEmissionBrightnesses[]{
    {"stefan-boltzmann", EmissionBrightness::stefanBoltzmann},
    {"planck", EmissionBrightness::planck},
    {"constant", EmissionBrightness::constant}};

/// The emission L_e of Eq. 2 of Schott et al. 2009 (times sigma_a, which is not asked for by itself): radiance that is
/// added per world unit of a ray, as a function of the second grid's values alone. VolumeReference::emissionGrid names
/// the grid.
struct EmissionSettings {
  EmissionKind kind = EmissionKind::blackBody;
  /// Temperature in kelvin, or the value that is looked up: scale * value + offset.
  double scale = 1, offset = 0;
  EmissionBrightness brightness = EmissionBrightness::stefanBoltzmann;
  /// Of a black body: the luminance that kEmissionReference kelvin add per world unit. Of a table: a factor.
  double intensity = 1;
  /// Whether the medium scatters it: once, and alike in all directions, in the models with occlusion but Phong's.
  bool lightsMedium = true;
  /// Of a table: sigma_s of this 1D function is the radiance per world unit.
  std::optional<TransferFunction> table;
  bool operator==(const EmissionSettings&) const = default;
};

/// Black bodies are compared at this temperature, that of a candle or a wood fire, K.
inline constexpr double kEmissionReference = 1500;
/// What is colder is dark, K: at 500 K a black body has a hundred millionth of its luminance at 1500 K.
inline constexpr double kEmissionDark = 500;
/// By stefan-boltzmann and constant, black bodies fade in between kEmissionDark and this, K: nobody sees what is colder
/// than 798 K (Draper's point) glow, whatever it radiates.
inline constexpr double kEmissionGlow = 1000;
/// What is hotter counts as this, K.
inline constexpr double kEmissionHottest = 10000;

/// Returns radiance per world unit as a function of the second grid's values, for renderers: it is sigma_s of a 1D
/// function, so that all that is known of these holds. Of black bodies it is linear between 400 temperatures, by which
/// it is off by at most 0.4 percent.
/// @throw InvalidArgument  a table that is missing or that also looks at gradients
TransferFunction emissionFunction(const EmissionSettings& settings);

/// Refuses an emission that would fill all of space. @param background  the second grid's
/// @throw InvalidArgument
void requireDarkBackground(const TransferFunction& emitted, double background);

}  // namespace umbrick
