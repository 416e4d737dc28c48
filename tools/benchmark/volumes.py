"""Volumes of the benchmark: arrays [z, y, x], voxel (x, y, z) at world (x, y, z) * spacing."""
# SPDX-License-Identifier: Apache-2.0
import gzip

import numpy as np


def load_raw(path, dims, dtype, mask=None):
    """A headerless file, x fastest, gzip'd or not, with one voxel of zeros added on every side, so that every renderer
    sees the same fade-out at the border."""
    opened = gzip.open if str(path).endswith(".gz") else open
    with opened(path, "rb") as file:
        voxels = np.frombuffer(file.read(), dtype)
    expected = dims[0] * dims[1] * dims[2]
    if voxels.size != expected:
        raise SystemExit(f"{path}: expected {expected} voxels, found {voxels.size}")
    if mask is not None:
        voxels = voxels & np.array(mask, dtype)
    return np.pad(voxels.reshape(dims[::-1]), 1)


def write_vdb(path, voxels, spacing, name="density"):
    """Voxels that are 0 become background. Slab by slab, since OpenVDB wants x first and a copy of that order."""
    import pyopenvdb as vdb

    grid = vdb.FloatGrid()
    grid.name = name
    grid.gridClass = vdb.GridClass.FOG_VOLUME
    grid.transform = vdb.createLinearTransform(
        [[spacing[0], 0, 0, 0], [0, spacing[1], 0, 0], [0, 0, spacing[2], 0], [0, 0, 0, 1]])
    for z in range(0, voxels.shape[0], 64):
        slab = np.ascontiguousarray(voxels[z:z + 64].transpose(2, 1, 0), np.float32)
        grid.copyFromArray(slab, ijk=(0, 0, z), tolerance=0)
    grid.prune()
    vdb.write(str(path), grids=[grid])
    return grid.activeVoxelCount()
