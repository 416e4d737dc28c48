// The loops of shear-warping over rows, for each set of SIMD instructions that the machine may have.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "sweep/brick_voxels.h"
#include "sweep/medium_table.h"

namespace umbrick {

/// Rays of a row are taken in groups of so many.
inline constexpr int kRayGroup = 16;
/// Buffers that rows are read from end with so many numbers more, which are read and not used.
inline constexpr int kRowPadding = 32;
/// What is interpolated: the value, the gradient of 2D functions, and light of one or three channels. Of classified
/// voxels sigma_t stands in the place of the value, and sigma_s by colour from kColourFields on. Last comes the value
/// of a second grid that emits light.
inline constexpr int kMostFields = 9;
inline constexpr int kLightFields = 2, kColourFields = 5, kEmissionField = 8;

/// Up to four rows of a brick's voxels between which a row is interpolated, in steps of the table.
struct VoxelRows {
  // Rows v and v + 1 of the slice at or in front of the row, then of the next one.
  std::array<const void*, 4> rows{};
  std::ptrdiff_t stride = 1;              // between voxels of a row
  float v = 0, n = 0;                     // shares of the second rows; n = 0: the second slice is not read
  float bias = 0, factor = 1, first = 0;  // steps = (code - bias) factor + first
};

/// Interpolates `count` voxels of rows.
void blendRows(VoxelCode code, const VoxelRows& rows, int count, float* out);

/// Where rays of a row lie on a slice: ray i at x0 + i spacing, in voxels of a buffer that begins with voxel `begin`.
struct RowPlaces {
  double x0 = 0, spacing = 1;
  std::int64_t begin = 0;
};

/// Interpolates fields of the rays first, ..., first + count - 1, whole groups.
/// @param rows  as blendRows makes them, each followed by kRowPadding numbers. Rays beyond their ends get anything.
void sampleRows(const RowPlaces& places, int first, int count, int length, int fields, const float* const* rows,
                float* const* out);

/// What a row of rays has gathered so far.
struct RowRays {
  float *red, *green, *blue, *opacity;  // premultiplied
  float* seen;                          // opacity times light, by power; null: is not asked for
  float* depth;                         // opacity times the way along the main axis; null with it
  const float* length;                  // world length of a ray between slices a voxel apart
  const float *enter, *leave;           // what clip planes leave of a ray: the way along the main axis, voxels
  std::uint8_t* full;                   // by group: all rays are as good as opaque
  /// Emitted light that reaches the eye, by colour; null: is not asked for.
  std::array<float*, 3> emitted{};
};

/// The space between two slices.
struct RowSegment {
  float from = 0, to = 0;                 // way along the main axis, voxels
  bool clipped = false;                   // some rays enter or leave in it
  float saturation = 0;                   // transmittance below which a ray is full
  bool midpoint = false;                  // the medium at the middle, for all of it
  bool classified = false;                // the fields are media
  int lights = 0;                         // channels of light among the fields, behind value and gradient
  std::array<float, 3> power{1, 1, 1};    // share of the power of each channel
  const MediumTable* emission = nullptr;  // of the second grid, whose sigma_s is what it emits; null: nothing does
};

/// Adds what lies between two slices to the rays first, ..., first + count - 1, whole groups.
/// @param front,back  the fields on both slices
void integrateRows(const MediumTable& table, const RowSegment& segment, const RowRays& rays, int first, int count,
                   const float* const* front, const float* const* back);

}  // namespace umbrick
