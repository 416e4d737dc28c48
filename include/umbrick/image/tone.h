// From radiance to what a display shows: exposure and tone curves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/core/names.h"

namespace umbrick {

enum class ToneMap {
  none,      // values above 1 are clamped
  reinhard,  // c / (1 + luminance)
  filmic,    // a fit of the ACES curve; the source is named at toneMapped
};
inline constexpr Name<ToneMap> kToneMaps[]{
    {"none", ToneMap::none}, {"reinhard", ToneMap::reinhard}, {"filmic", ToneMap::filmic}};

/// Stops beyond which an exposure is a mistake: 2^100 is more than single precision holds of any radiance.
inline constexpr double kMostStops = 100;

/// Returns the factor by which an exposure multiplies radiance: 2^stops.
/// @throw InvalidArgument  not a finite number, or more than kMostStops in size
double exposureFactor(double stops);

/// Returns linear display values of a linear colour; what is above 1 is cut off when it is stored. All curves take 0 to
/// 0 and rise.
///   none      c
///   reinhard  c / (1 + luminance), Reinhard et al. 2002, doi:10.1145/566654.566575, Eq. 3
///   filmic    c (2.51 c + 0.03) / (c (2.43 c + 0.59) + 0.14), Narkowicz 2015, "ACES Filmic Tone Mapping Curve",
///   without
///             his exposure of 0.6
glm::dvec3 toneMapped(const glm::dvec3& colour, ToneMap toneMap);

}  // namespace umbrick
