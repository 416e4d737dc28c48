#!/usr/bin/env python3
# The array of a simulation to a sparse .vdb: simulation_to_vdb.py plume.vdb
# SPDX-License-Identifier: Apache-2.0
"""Simulates a plume of smoke for a few steps with NumPy, and saves its density as a sparse grid with a stated loss."""
import argparse

import numpy as np

import umbrick

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("output", help=".vdb, .nvdb or .nrrd")
parser.add_argument("--cells", type=int, default=64, help="along x and y; twice as many along z [64]")
arguments = parser.parse_args()

# Smoke enters at the bottom, rises with a swirl, and diffuses. Element [x, y, z].
n = arguments.cells
x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
density = np.zeros((n, n, 2 * n), np.float32)
for step in range(2 * n):
    turn = 0.3 * step / n * np.pi
    source = np.exp(-(((x - 0.2 * np.cos(turn)) ** 2 + (y - 0.2 * np.sin(turn)) ** 2) / 0.02))
    density = np.roll(density, 1, axis=2)
    density[:, :, 0] = source
    for axis in (0, 1):
        density += 0.1 * (np.roll(density, 1, axis) + np.roll(density, -1, axis) - 2 * density)

# World units are metres: the plume is 2 m high. What is off by no more than 0.001 may go.
volume = umbrick.convert(density, spacing=(1 / n, 1 / n, 1 / n), length_unit="m", max_error=1e-3)
losses = volume.losses
written = volume.save(arguments.output)
print(f"{losses['active_voxels']} of {losses['voxels']} voxels are stored as {losses['storage']}; "
      f"none is off by more than {losses['max_error']:.2g}")
print(f"{density.nbytes} bytes in memory, {written['bytes']} bytes in {arguments.output}")
