// SSIM: structural similarity of two pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>

#include "umbrick/image/image.h"

namespace umbrick {

inline constexpr int kSsimWindow = 11;  // pixels along an edge

/// Returns the mean structural similarity, in [-1, 1]; it is 1 for equal pictures.
///
/// Both pictures are taken as a screen shows them: over `background`, clamped to [0, 1], with NaN as 0. Their luminance
/// (Rec. 709) is encoded with the sRGB curve. With means m, variances v and covariance c under a Gaussian window of
/// 11 x 11 pixels, sigma 1.5,
///   SSIM = (2 m_a m_b + 0.01^2) (2 c + 0.03^2) / ((m_a^2 + m_b^2 + 0.01^2) (v_a + v_b + 0.03^2))
/// The mean is over the windows that lie inside the picture.
/// Source: Wang, Bovik, Sheikh, Simoncelli 2004, doi:10.1109/TIP.2003.819861.
///
/// @param test, reference  linear premultiplied RGBA, or RGB
/// @param background       linear RGB in [0, 1]
/// @throw InvalidArgument  sizes or channel counts that differ, not 3 or 4 channels, below 11 x 11 pixels, or a
///                         background out of range
double meanSsim(const Image& test, const Image& reference, const glm::dvec3& background = glm::dvec3(0));

}  // namespace umbrick
