// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/picture_mean.h"

#include <cmath>
#include <limits>

namespace umbrick {

void PictureMean::add(const Picture& picture) {
  if (count_ == 0) {
    colour_.assign(picture.colour.pixels.size(), 0);
    visibility_.assign(picture.visibility.pixels.size(), 0);
    opacity_.assign(picture.opacity.pixels.size(), 0);
    depth_.assign(picture.depth.pixels.size(), 0);
  }
  for (std::size_t i = 0; i < colour_.size(); ++i) colour_[i] += picture.colour.pixels[i];
  for (std::size_t i = 0; i < visibility_.size(); ++i) visibility_[i] += picture.visibility.pixels[i];
  for (std::size_t i = 0; i < opacity_.size(); ++i) opacity_[i] += picture.opacity.pixels[i];
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    const float depth = picture.depth.pixels[i];
    if (std::isfinite(depth)) depth_[i] += static_cast<double>(picture.opacity.pixels[i]) * depth;
  }
  ++count_;
}

void PictureMean::store(Picture& picture) const {
  for (std::size_t i = 0; i < colour_.size(); ++i) picture.colour.pixels[i] = static_cast<float>(colour(i));
  for (std::size_t i = 0; i < visibility_.size(); ++i)
    picture.visibility.pixels[i] = static_cast<float>(visibility_[i] / count_);
  for (std::size_t i = 0; i < opacity_.size(); ++i)
    picture.opacity.pixels[i] = static_cast<float>(opacity_[i] / count_);
  for (std::size_t i = 0; i < depth_.size(); ++i)
    picture.depth.pixels[i] =
        opacity_[i] > 0 ? static_cast<float>(depth_[i] / opacity_[i]) : std::numeric_limits<float>::infinity();
}

}  // namespace umbrick
