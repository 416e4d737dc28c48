// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/blank_picture.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "umbrick/draw/value_picture.h"

namespace umbrick {

Picture blankPicture(const ResolvedScene& scene, bool layers) {
  const int width = scene.camera.width, height = scene.camera.height;
  Picture picture;
  picture.colour = Image(width, height, 4);
  for (std::size_t i = 0; i < picture.colour.pixels.size(); i += 4)
    storeOver(scene, glm::dvec4(0), &picture.colour.pixels[i]);
  if (!layers) return picture;
  picture.visibility = picture.opacity = picture.depth = Image(width, height, 1);
  std::fill(picture.depth.pixels.begin(), picture.depth.pixels.end(), std::numeric_limits<float>::infinity());
  return picture;
}

}  // namespace umbrick
