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

/// A medium at a point: extinction in 1/world unit and the share of it that is scattering, linear RGB.
struct Medium {
  glm::dvec3 albedo{0};
  double sigma_t = 0;  // 1/world unit
  glm::dvec3 sigma_s() const { return albedo * sigma_t; }
  bool operator==(const Medium&) const = default;
};

/// Piecewise linear from control points: albedo and sigma_t each linear between neighbours, constant beyond the ends
/// (as ParaView's colour and opacity functions are). Classification happens after interpolation of the value.
///
/// A 2D function gives the medium on a rectilinear lattice of (value, gradient) with bilinear interpolation, constant
/// beyond its edges. Gradient magnitude is in grid units per world unit.
///
/// Two equal values make a step: the first holds below it, the second at it and above. Of more than two equal ones the
/// first and the last count. NaN is no medium.
class TransferFunction {
 public:
  struct Point {
    double value = 0;  // grid units
    Medium medium;
  };

  /// @throw InvalidArgument  no points, values not ascending (two equal ones make a step), sigma_t < 0,
  ///                         albedo outside [0, 1], anything not finite
  explicit TransferFunction(std::vector<Point> points);
  /// @param media  values.size() x gradients.size(), value fastest
  /// @throw InvalidArgument  as above, for both axes
  TransferFunction(std::vector<double> values, std::vector<double> gradients, std::vector<Medium> media);

  bool is2d() const { return !gradients_.empty(); }
  Medium operator()(double value, double gradient = 0) const;

  /// Where the function varies: first to last control point, rounded outwards.
  Range valueDomain() const;
  Range gradientDomain() const;  // {0, 0} for 1D

  /// True when sigma_t is 0 everywhere over the ranges (exact for the piecewise function; no widening).
  bool isTransparent(const Range& value, const Range& gradient = {0, 0}) const;
  /// Largest sigma_t over the ranges (its supremum, where a step cuts it off), 1/world unit; 0 for an empty range.
  double majorant(const Range& value, const Range& gradient = {0, 0}) const;

  /// The same function with its domain stretched to [low, high] (window: level -/+ width / 2); a domain of no extent,
  /// as of a single step, moves to the middle.
  /// @throw InvalidArgument  low >= high or not finite
  TransferFunction windowed(double low, double high) const;
  /// The same function with sigma_t times `factor`. @throw InvalidArgument  factor < 0 or not finite
  TransferFunction scaled(double factor) const;

  const std::vector<double>& values() const { return values_; }
  const std::vector<double>& gradients() const { return gradients_; }
  const std::vector<Medium>& media() const { return media_; }
  bool operator==(const TransferFunction&) const = default;

 private:
  std::vector<double> values_, gradients_;
  std::vector<Medium> media_;
};

/// Reads the project's JSON, of a 1D or a 2D function,
///   {"points": [{"value": 500, "albedo": [0.8, 0.5, 0.4], "sigma_t": 0.1}, ...]}
///   {"values": [...], "gradients": [...], "albedo": [[r, g, b], ...], "sigma_t": [...]}    lattice, value fastest
/// with the optional fields "description", "window": [low, high] and "sigmaScale", or a ParaView colour-map export: an
/// array with one object of "RGBPoints", "Points", "ColorSpace", ... There colours are sRGB display values, as ParaView
/// shows them; they are interpolated in the colour space that is named (CIEDE2000 as Lab) and become linear albedo.
/// Opacity a per ScalarOpacityUnitDistance u (1 when it is missing) becomes sigma_t = -ln(1 - a) / u, where opacity
/// above 0.999 counts as 0.999 (6.9 / u), since 1 would be no finite medium; without "Points" it rises from 0 to 1 over
/// the colours. Both are curves between ParaView's points, replaced by linear pieces within half a level of 8 bits.
/// @param source  what messages call the text, usually its file name
/// @throw IoError  malformed: names source, line, column and field
TransferFunction parseTransferFunction(std::string_view text, const std::string& source);
/// A preset's name (see transferPresets) or a file. @throw IoError
TransferFunction loadTransferFunction(const std::string& nameOrFile);
/// Names of the presets that are part of the library.
std::vector<std::string> transferPresets();
/// The project's JSON of a function: parse(print(f)) == f.
std::string printTransferFunction(const TransferFunction& transfer);

}  // namespace umbrick
