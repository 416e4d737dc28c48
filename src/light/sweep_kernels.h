// The loops over rows of voxels in which almost all time of a light volume goes, for each set of SIMD instructions that
// the machine may have.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace umbrick {

/// Rows that loops read and write end with so many numbers more. Those that are read are not used, and those that are
/// written stay as they were.
inline constexpr int kRowPadding = 32;

/// Light is summed in whole numbers, so that the order of sums does not matter, and so that what was added can be taken
/// away again without a trace. This is the number of light 1.
inline constexpr float kWholeLight = 1 << 22;

/// Two rows of voxels of a slice and how the paths of one direction lie between them: path i is at u between voxels
/// i spacing and i spacing + 1, and at v between the rows, both in [0, 1). Voxels are values in steps of an
/// ExtinctionTable.
struct PathRow {
  const float *near = nullptr, *far = nullptr;  // to one voxel behind the last path, and kRowPadding more
  float u = 0, v = 0;
};

/// A surface on which values are `value` steps, and the optical depth of each of its crossings.
struct PathSurface {
  float value = 0, depth = 0;
};

/// What a path meets between two slices.
struct PathMedium {
  const float *integrals = nullptr, *means = nullptr;  // see ExtinctionTable
  float below = 0, above = 0;
  float emptyBelow = 0, emptyAbove = 0;  // there is no medium at values up to the one, and from the other on
  float length = 0;                      // of a path between two slices, world units
  const PathSurface* surfaces = nullptr;
  int surfaceCount = 0;
};

/// Takes paths from the slice before to this one: depth grows by the optical depth in between, and `through` gets the
/// transmittance. That is 0 from kDarkDepth on, where paths are no longer followed.
/// @param spacing  voxels between paths along a row, 1 or 2
/// @param through  null: is not asked for
void carryRow(const PathRow& before, const PathRow& here, const PathMedium& medium, int spacing, float* depth,
              float* through, int count);
inline constexpr float kDarkDepth = 24;

/// A plane that cuts the medium: its distance is base + i step at path i on this slice, and grows by `rate` from slice
/// to slice.
struct RowPlane {
  float base = 0, step = 0, rate = 0;
  // By how many slices later paths meet it that lie a place of light farther out, along the axis nearest to its normal.
  float slicesPerPlace = 1;
  float cosine = 1;  // between the light and the plane's normal, world
};
/// Does the same where there is medium only inside of planes. Before the medium, `through` is more than what arrives,
/// so that what is read linearly between there and the first voxel within looks right; behind it, it goes on falling.
void carryCutRow(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
                 int planeCount, int spacing, float* depth, float* through, int count);

/// Where the voxels of a row lie among the paths of one direction, and what these count. Voxel i lies between the paths
/// i - 1 and i of the rows before and after it; u and v are the shares of the ones before, in [0, 1].
struct PathShare {
  float u = 0, v = 0;
  std::array<float, 3> weight{};  // by channel, times kWholeLight
};
/// Adds weight * transmittance to voxels.
void addRow(const float* before, const float* after, const PathShare& share, int channels, std::int32_t* const* light,
            int count);

}  // namespace umbrick
