// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/tone.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

double exposureFactor(double stops) {
  if (!(std::abs(stops) <= kMostStops))
    throw InvalidArgument("exposure: found " + std::to_string(stops) + " stops, must be from -100 to 100");
  return std::exp2(stops);
}

glm::dvec3 toneMapped(const glm::dvec3& colour, ToneMap toneMap) {
  switch (toneMap) {
    case ToneMap::none:
      return colour;
    case ToneMap::reinhard:
      return colour / (1 + glm::dot(colour, glm::dvec3(0.2126, 0.7152, 0.0722)));
    case ToneMap::filmic:
      return colour * (2.51 * colour + 0.03) / (colour * (2.43 * colour + 0.59) + 0.14);
  }
  return colour;
}

}  // namespace umbrick
