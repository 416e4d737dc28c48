// The loops over rows of voxels in which almost all time of a light volume goes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

/// Two rows of voxels of a slice and how the paths of one direction lie between them: path i is at u between voxels i
/// and i + 1, and at v between the rows, both in [0, 1). Voxels are values in steps of an ExtinctionTable.
struct PathRow {
  const float *near = nullptr, *far = nullptr;  // one voxel more than there are paths
  float u = 0, v = 0;
};

/// What a path meets between two slices.
struct PathMedium {
  const float* integrals = nullptr;  // see ExtinctionTable
  float below = 0, above = 0;
  float emptyBelow = 0, emptyAbove = 0;  // there is no medium at values up to the one, and from the other on
  float length = 0;                      // of a path between two slices, world units
};

/// Takes paths from the slice before to this one: depth grows by the optical depth in between, and `through` gets the
/// transmittance.
void carryRow(const PathRow& before, const PathRow& here, const PathMedium& medium, float* depth, float* through,
              int count);

/// A plane that cuts the medium: its distance is base + i step at path i on this slice, and grows by `rate` from slice
/// to slice.
struct RowPlane {
  float base = 0, step = 0, rate = 0;
};
/// Does the same where there is medium only inside of planes. Outside, `through` goes on as it changes inside.
void carryCutRow(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
                 int planeCount, float* depth, float* through, int count);

/// Adds weight * transmittance to voxels. Voxel i lies between the paths i - 1 and i of the rows before and after it;
/// u and v are those of the paths.
void addRow(const float* before, const float* after, float u, float v, float weight, float* light, int count);

}  // namespace umbrick
