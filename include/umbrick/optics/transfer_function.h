// Grid value (and gradient magnitude) to a participating medium.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/core/range.h"

namespace umbrick {

/// A medium at a point: its extinction in 1/world unit, and the share of it that is scattering, as linear RGB.
struct Medium {
  glm::dvec3 albedo{0};
  double sigma_t = 0;  // 1/world unit
  glm::dvec3 sigma_s() const { return albedo * sigma_t; }
  bool operator==(const Medium&) const = default;
};

/// A transfer function. A 1D function is piecewise linear between control points: albedo and sigma_t are each linear
/// between neighbours and constant beyond the ends, as ParaView's colour and opacity functions are. Classification
/// happens after interpolation of the value.
///
/// A 2D function gives the medium on a rectilinear lattice of (value, gradient), with bilinear interpolation, and is
/// constant beyond its edges. Gradient magnitude is in grid units per world unit.
///
/// Two equal values make a step: the first point holds below it, the second one at it and above. Of more than two equal
/// values the first and the last count. NaN is no medium.
class TransferFunction {
 public:
  struct Point {
    double value = 0;  // grid units
    Medium medium;
  };

  /// @throw InvalidArgument  no points, values not ascending (two equal ones make a step), sigma_t < 0, albedo outside
  ///                         [0, 1], or anything not finite
  explicit TransferFunction(std::vector<Point> points);
  /// @param media  values.size() x gradients.size(), value fastest
  /// @throw InvalidArgument  as for 1D, for both axes
  TransferFunction(std::vector<double> values, std::vector<double> gradients, std::vector<Medium> media);

  bool is2d() const { return !gradients_.empty(); }
  Medium operator()(double value, double gradient = 0) const;

  /// Returns where the function varies: from the first to the last control point, rounded outwards.
  Range valueDomain() const;
  Range gradientDomain() const;  // {0, 0} for a 1D function

  /// Returns true when sigma_t is 0 everywhere over the ranges. This is exact for the piecewise function, whose ranges
  /// are not widened.
  bool isTransparent(const Range& value, const Range& gradient = {0, 0}) const;
  /// Returns the largest sigma_t over the ranges, 1/world unit; its supremum where a step cuts it off; 0 for
  /// an empty range.
  double majorant(const Range& value, const Range& gradient = {0, 0}) const;

  /// The unit of the values, where the function is made for one: "HU", or "HU + 1000" of CTs that store no negative
  /// numbers. Empty: the function's values are those of the grid, whatever they mean.
  const std::string& unit() const { return unit_; }
  TransferFunction withUnit(std::string unit) const;
  /// Returns the same function of values that are larger by `offset`. @throw InvalidArgument  offset is not finite
  TransferFunction shifted(double offset) const;

  /// Returns the same function with its domain stretched to [low, high] (a window: level -/+ width / 2). A domain of no
  /// extent, as of a single step, moves to the middle. The new values are the grid's: there is no unit any more.
  /// @throw InvalidArgument  low >= high, or not finite
  TransferFunction windowed(double low, double high) const;
  /// Returns the same function with sigma_t times `factor`. @throw InvalidArgument  factor < 0 or not finite
  TransferFunction scaled(double factor) const;

  const std::vector<double>& values() const { return values_; }
  const std::vector<double>& gradients() const { return gradients_; }
  const std::vector<Medium>& media() const { return media_; }
  bool operator==(const TransferFunction&) const = default;

 private:
  std::vector<double> values_, gradients_;
  std::vector<Medium> media_;
  std::vector<double> maxima_;  // of sigma_t over control points, as a binary tree; of a 1D function only
  std::string unit_;

  void findMaxima();
};

/// Reads the project's JSON of a 1D or a 2D function,
///   {"points": [{"value": 500, "albedo": [0.8, 0.5, 0.4], "sigma_t": 0.1}, ...]}
///   {"values": [...], "gradients": [...], "albedo": [[r, g, b], ...], "sigma_t": [...]}    lattice, value fastest
/// with the optional fields "description", "unit" (of the values), "window": [low, high] and "sigmaScale"; or a colour
/// map exported by ParaView, which is an array with one object of "RGBPoints", "Points", "ColorSpace" and so on.
///
/// The colours of ParaView are sRGB display values, as it shows them. They are interpolated in the colour space that is
/// named (CIEDE2000 as Lab) and become linear albedo. Opacity a per ScalarOpacityUnitDistance u (1 when it is missing)
/// becomes sigma_t = -ln(1 - a) / u. Opacity above 0.999 counts as 0.999 (6.9 / u), since 1 would be no finite medium.
/// Without "Points" it rises from 0 to 1 over the colours. Both are curves between ParaView's points, and are replaced
/// by linear pieces within half a level of 8 bits.
/// @param source  what messages call the text, usually its file name
/// @throw IoError  malformed text; the message names source, line, column and field
TransferFunction parseTransferFunction(std::string_view text, const std::string& source);
/// Loads a preset by its name (see transferPresets) or a file. @throw IoError  there is neither, or it is malformed
TransferFunction loadTransferFunction(const std::string& nameOrFile);
/// Returns the names of the presets that are part of the library.
std::vector<std::string> transferPresets();
/// Returns the description of a preset or of a file; empty where there is none. @throw IoError  as above
std::string describeTransferFunction(const std::string& nameOrFile);
/// Returns the project's JSON of a function, so that parse(print(f)) == f.
std::string printTransferFunction(const TransferFunction& transfer);

}  // namespace umbrick
