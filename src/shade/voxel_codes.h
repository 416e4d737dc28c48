// Grid values as shaders read them voxel by voxel, see shaders/shade/voxel_fetch.glsl.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/gl/program.h"

namespace umbrick {

/// value = offset + unit * code. Codes of fixed-point texels are whole numbers, and where voxels are whole numbers that
/// fit, a unit is 1: no rounding then comes between a voxel and its value.
class VoxelCodes {
 public:
  explicit VoxelCodes(const ResidentVolume& resident);
  double toValue(double code) const { return offset_ + unit_ * code; }
  double toCode(double value) const { return (value - offset_) / unit_; }
  /// The most by which a code is off, beyond what a float is.
  double rounding() const { return rounding_; }

  void setConstants(ShaderConstants& constants) const;
  void setUniforms(GlProgram& program) const;

 private:
  bool fixedPoint_ = false;
  double perTexel_ = 1, unit_ = 1, offset_ = 0, rounding_ = 0;
  double storedEmpty_ = 0, empty_ = 0;  // codes of empty space
  int apron_ = 1;
};

}  // namespace umbrick
