// What all rays of a picture share, however they march.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

#include "sweep/brick_voxels.h"
#include "sweep/medium_table.h"
#include "sweep/row_kernels.h"

namespace umbrick {

struct SweptFrame {
  const BrickVoxels* voxels = nullptr;
  const MediumTable* table = nullptr;
  const MediumTable* emission = nullptr;  // of the second grid; null: nothing emits
  float saturation = 0;
  bool midpoint = false, aux = false;
  bool classified = false;  // voxels have media, which are interpolated
  int lights = 0;           // channels of light beside the voxels
  float lightUnit = 1;
  std::array<float, 3> power{1, 1, 1};

  /// Returns the space between two slices. @param first  the slice that the way is counted from; all along n
  RowSegment segment(double first, double from, double to) const {
    RowSegment part;
    part.from = static_cast<float>(std::abs(from - first));
    part.to = static_cast<float>(std::abs(to - first));
    part.saturation = saturation;
    part.midpoint = midpoint;
    part.classified = classified;
    part.lights = lights;
    part.power = power;
    part.emission = emission;
    return part;
  }
};

}  // namespace umbrick
