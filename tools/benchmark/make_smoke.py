#!/usr/bin/python3
"""Writes a sparse plume of smoke: values 0 to 5, a few per cent of the voxels above 0, the same for the same seed.

The plume is a swirling, widening column whose radius and edge are torn by fractal noise (cubic B-splines over random
lattices, five octaves), so that it has fine wisps, smooth edges and long empty stretches between them.
Needs Debian's python3-numpy and python3-openvdb."""
# SPDX-License-Identifier: Apache-2.0
import argparse

import numpy as np

from volumes import write_vdb


def spline_weights(size, cells):
    """size x (cells + 3) weights of a uniform cubic B-spline over a lattice of that many cells."""
    at = (np.arange(size) + 0.5) * (cells / size)
    cell = np.floor(at).astype(int)
    t = at - cell
    weights = np.zeros((size, cells + 3))
    for k, w in enumerate([(1 - t)**3 / 6, (3 * t**3 - 6 * t**2 + 4) / 6,
                           (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6, t**3 / 6]):
        weights[np.arange(size), cell + k] = w
    return weights.astype(np.float32)


class Noise:
    """Smooth noise of one wavelength, evaluated one slab of planes at a time."""

    def __init__(self, random, size, cells):
        self.lattice = (random.random((cells + 3,) * 3, np.float32) - 0.5)
        self.weights = spline_weights(size, cells)

    def slab(self, first, last):
        planes = np.tensordot(self.weights[first:last], self.lattice, (1, 0))  # z, cells y, cells x
        return self.weights @ planes @ self.weights.T


def smoke(size, seed):
    random = np.random.Generator(np.random.PCG64(seed))
    drift_x, drift_y = Noise(random, size, 5), Noise(random, size, 5)
    octaves = [(Noise(random, size, cells), 2.0 * gain) for cells, gain in
               [(10, 1.0), (20, 0.55), (40, 0.32), (80, 0.18), (160, 0.1)]]
    y, x = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size, indexing="ij")
    voxels = np.zeros((size, size, size), np.float32)
    for first in range(0, size, 32):
        last = min(first + 32, size)
        z = ((np.arange(first, last) + 0.5) / size)[:, None, None]
        centre_x = 0.5 + 0.13 * z * np.sin(7 * z + 0.5)
        centre_y = 0.5 + 0.13 * z * np.cos(6 * z)
        radius = 0.05 + 0.24 * z**0.9
        dx = x - centre_x + 0.45 * z * drift_x.slab(first, last)
        dy = y - centre_y + 0.45 * z * drift_y.slab(first, last)
        envelope = 1 - (dx * dx + dy * dy) / (radius * radius)
        noise = sum(gain * octave.slab(first, last) for octave, gain in octaves)
        # Dense and whole at the source, torn further up, and gone before the box ends.
        tear = 0.12 + 0.62 * z
        fade = np.clip((z - 0.03) / 0.05, 0, 1) * np.clip((0.95 - z) / 0.25, 0, 1)
        body = np.clip(envelope * fade + 2.3 * noise * np.clip(envelope + 0.6, 0, 1) - tear, 0, None)
        density = 5 * body**1.5 / (0.35 + body**1.5)
        density[density < 1e-3] = 0
        voxels[first:last] = density * (envelope > -0.6)
    for face in (voxels, voxels.transpose(1, 0, 2), voxels.transpose(2, 0, 1)):
        face[0] = face[-1] = 0
    return voxels


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=512, help="voxels along each edge (512)")
    parser.add_argument("--seed", type=int, default=7, help="of the noise (7)")
    parser.add_argument("--raw", help="dense 32-bit floats, x fastest")
    parser.add_argument("--vdb", help="sparse float grid \"density\", voxel edge 1")
    arguments = parser.parse_args()
    if not arguments.raw and not arguments.vdb:
        parser.error("nothing to write: give --raw or --vdb")
    voxels = smoke(arguments.size, arguments.seed)
    print(f"{np.count_nonzero(voxels)} of {voxels.size} voxels above 0 ({100 * np.mean(voxels > 0):.2f} %), "
          f"largest {voxels.max():.3f}")
    if arguments.raw:
        voxels.astype("<f4").tofile(arguments.raw)
    if arguments.vdb:
        print(f"{arguments.vdb}: {write_vdb(arguments.vdb, voxels, (1, 1, 1))} active voxels")


if __name__ == "__main__":
    main()
