// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/picture_mean.h"

#include <cmath>
#include <limits>

namespace umbrick {

void ColourMean::add(const Image& colour) {
  if (count_ == 0) sum_.assign(colour.pixels.size(), 0);
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += colour.pixels[i];
  ++count_;
}

void PictureMean::add(const Picture& picture) {
  if (count_ == 0) {
    visibility_.assign(picture.visibility.pixels.size(), 0);
    opacity_.assign(picture.opacity.pixels.size(), 0);
    depth_.assign(picture.depth.pixels.size(), 0);
    layers_.clear();
    for (const ImageLayer& layer : picture.layers)
      layers_.push_back({std::vector<double>(layer.image.pixels.size()), std::vector<int>(layer.image.pixels.size())});
  }
  colour_.add(picture.colour);
  for (std::size_t i = 0; i < visibility_.size(); ++i) visibility_[i] += picture.visibility.pixels[i];
  for (std::size_t i = 0; i < opacity_.size(); ++i) opacity_[i] += picture.opacity.pixels[i];
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    const float depth = picture.depth.pixels[i];
    if (std::isfinite(depth)) depth_[i] += static_cast<double>(picture.opacity.pixels[i]) * depth;
  }
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const std::vector<float>& numbers = picture.layers[k].image.pixels;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!std::isfinite(numbers[i])) continue;
      layers_[k].sum[i] += numbers[i];
      ++layers_[k].count[i];
    }
  }
  ++count_;
}

void PictureMean::store(Picture& picture) const {
  for (std::size_t i = 0; i < values(); ++i) picture.colour.pixels[i] = static_cast<float>(colour_[i]);
  for (std::size_t i = 0; i < visibility_.size(); ++i)
    picture.visibility.pixels[i] = static_cast<float>(visibility_[i] / count_);
  for (std::size_t i = 0; i < opacity_.size(); ++i)
    picture.opacity.pixels[i] = static_cast<float>(opacity_[i] / count_);
  for (std::size_t i = 0; i < depth_.size(); ++i)
    picture.depth.pixels[i] =
        opacity_[i] > 0 ? static_cast<float>(depth_[i] / opacity_[i]) : std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < layers_.size(); ++k)
    for (std::size_t i = 0; i < layers_[k].sum.size(); ++i)
      if (layers_[k].count[i] > 0)
        picture.layers[k].image.pixels[i] = static_cast<float>(layers_[k].sum[i] / layers_[k].count[i]);
}

}  // namespace umbrick
