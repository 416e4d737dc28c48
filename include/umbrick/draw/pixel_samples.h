// The pictures that a picture of several samples a pixel is the mean of, one by one: for who draws them elsewhere.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "umbrick/draw/picture_mean.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Draws one of the pictures that Renderer::render() averages: the scene through one of pixelPoints(), that of `index`.
/// It depends on nothing but renderer's scene, sample and index.
/// @param index  in [0, scene().sampling.pixelSamples)
/// @throw InvalidArgument  an index beyond the samples; as Renderer
Picture renderPixelSample(Renderer& renderer, std::size_t index, const RenderSample& sample = {});

/// Averages such pictures. In the order of their indices the mean is that of Renderer::render() to the bit.
class PixelSampleMean {
 public:
  void add(Picture picture);
  /// Returns the mean; times and counts are sums, other statistics those of the last picture.
  /// @pre add()
  Picture mean() const;

 private:
  PictureMean sum_;
  Picture last_;
};

}  // namespace umbrick
