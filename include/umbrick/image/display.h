// A picture as it is looked at: exposure, tone curve and what stands behind it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/image/image.h"
#include "umbrick/image/tone.h"

namespace umbrick {

enum class Backdrop {
  none,      // what is transparent stays so
  gradient,  // dark above, light below, see gradientBackdrop
};

struct Look {
  ToneMap toneMap = ToneMap::none;
  double exposure = 0;  // stops: radiance is multiplied by 2^exposure before the tone curve
  Backdrop backdrop = Backdrop::none;
  bool operator==(const Look&) const = default;
};

/// Returns the linear display colour of a radiance.
glm::dvec3 displayed(const glm::dvec3& radiance, const Look& look);

/// Returns the backdrop's linear display colour, neutral with a little blue, so that neither white nor black media
/// vanish in front of it. It is even in sRGB and depends neither on the exposure nor on the tone curve.
/// @param height  0 at the lower edge of the picture, 1 at the upper one
glm::dvec3 gradientBackdrop(double height);

/// Returns a picture in linear display values, premultiplied. Exposure and tone curve act on the colour over its own
/// alpha; the backdrop is composited under it in linear light, after them, and makes the picture opaque. NaN counts as
/// 0.
/// @param picture  4 channels, linear radiance, premultiplied
/// @throw InvalidArgument  not 4 channels; an exposure that exposureFactor refuses
Image displayed(const Image& picture, const Look& look);

}  // namespace umbrick
