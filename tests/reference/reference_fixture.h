// Media with closed forms, as grids, and what the reference makes of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/closed_forms.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/reference/reference.h"

namespace umbrick {

/// Returns an environment map of the view with up to `radiance` in each channel: constant, or each pixel with
/// its own colour.
inline LightSource environmentOf(int width, int height, const glm::dvec3& radiance, bool varied) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = static_cast<float>(radiance[c] * (varied ? ((5 * x + 3 * y + 7 * c) % 11) / 10.0 : 1));
  EnvironmentLight light;
  light.image = std::make_shared<const Image>(std::move(image));
  light.up = {0.3, 0.9, 0.4};
  return {LightFrame::view, light};
}

}  // namespace umbrick
