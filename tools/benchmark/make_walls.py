#!/usr/bin/python3
"""Writes an analytic scene of hard occluders: a wall and a post on a floor, a hollow shell, and a translucent slab.

Values are 0 (empty), 0.25 (translucent) and 1 (solid); walls_transfer.json goes with it.
Needs Debian's python3-numpy and python3-openvdb."""
# SPDX-License-Identifier: Apache-2.0
import argparse

import numpy as np

from volumes import write_vdb


def walls(size):
    z, y, x = np.meshgrid(*[(np.arange(size) + 0.5) * (48 / size)] * 3, indexing="ij", sparse=True)
    radius = np.sqrt((x - 30)**2 + (y - 17)**2 + (z - 18)**2)
    solid = (z < 5) | ((x >= 8) & (x < 12) & (z < 34)) | ((x > 38) & (y > 38) & (z < 26)) | ((radius > 7) & (radius < 10))
    thin = (y > 24) & (x > 14) & (x < 36) & (z > 28) & (z < 34)
    return np.where(solid, 1.0, np.where(thin, 0.25, 0.0)).astype(np.float32)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=192, help="voxels along an edge (default 192)")
    parser.add_argument("--vdb", required=True, help="file to write; a voxel is 48 / size long")
    arguments = parser.parse_args()
    write_vdb(arguments.vdb, walls(arguments.size), [48 / arguments.size] * 3)


if __name__ == "__main__":
    main()
