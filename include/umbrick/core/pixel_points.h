// Places inside a pixel: a pixel has an area, and what it shows is the mean over it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace umbrick {

/// The step of the low-discrepancy sequence of single numbers whose point i is fract(start + i step): 1 / golden ratio.
inline constexpr double kGoldenStep = 0.6180339887498949;

/// Returns `count` points of the unit square over which a pixel is averaged, all with the same weight: the box filter,
/// that is the mean over the pixel's area. One point is the centre.
///
/// Each of `count` columns and each of `count` rows of the square holds one point in its middle, so that the mean is
/// off by at most 1 / (2 count) at an edge along an axis, and exact where the picture is linear. Which row belongs to a
/// column follows from the order of the multiples of the golden ratio, so that points lie evenly in other directions,
/// too: a Fibonacci lattice (Zaremba 1966) for any number of points.
/// @throw InvalidArgument  count < 1
std::vector<glm::dvec2> pixelPoints(int count);

/// Returns when each of pixelPoints(count) is seen while something moves, as shares of the time: one in the middle of
/// each of `count` parts, in an order (of the multiples of the square root of 2) that has nothing to do with where in
/// the pixel the points lie. @throw InvalidArgument  count < 1
std::vector<double> pixelTimes(int count);

/// Returns what a file says of the filter: "box, 16 samples a pixel", or "point, the centre of each pixel".
std::string pixelFilter(int count);

}  // namespace umbrick
