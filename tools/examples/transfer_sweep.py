#!/usr/bin/env python3
# What the density of a medium does to the error of its picture: transfer_sweep.py assets/densityAndHeat.vdb sweep.png
# SPDX-License-Identifier: Apache-2.0
"""Sweeps the extinction of a transfer function, and plots how far pictures are from the reference."""
import argparse

import matplotlib

matplotlib.use("Agg")  # no display is needed
from matplotlib import pyplot

import umbrick

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("input", help="any volume")
parser.add_argument("output", help="the plot: .png, .svg or .pdf")
parser.add_argument("--steps", type=int, default=6, help="of the extinction, each twice as dense [6]")
parser.add_argument("--size", type=int, default=96, help="of the pictures, pixels [96]")
arguments = parser.parse_args()

volume = umbrick.Volume.open(arguments.input)
tf = umbrick.tf_auto(volume)
scene = dict(model="emission", size=(arguments.size, arguments.size), zoom=1)
scales = [0.25 * 2**step for step in range(arguments.steps)]
errors = {}
for spacing in (2.0, 0.5):
    errors[spacing] = []
    # The transfer function changes; bricks that are resident stay.
    renderer = umbrick.Renderer(volume, tf=tf, spacing=spacing, **scene)
    for scale in scales:
        denser = dict(tf, points=[dict(point, sigma_t=point["sigma_t"] * scale) for point in tf["points"]])
        picture = renderer.set_transfer(denser).render()
        truth = umbrick.reference(volume, picture.scene)
        errors[spacing].append(umbrick.compare(picture, truth)["rmse"])

print("spacing  extinction  RMSE")
for spacing, row in errors.items():
    for scale, error in zip(scales, row):
        print(f"{spacing:7}  {scale:10}  {error:.2e}")
    pyplot.loglog(scales, row, "o-", label=f"slabs of {spacing} voxels")
pyplot.xlabel("extinction, multiples of the suggested one")
pyplot.ylabel("RMSE against the reference")
pyplot.legend()
pyplot.savefig(arguments.output, dpi=120)
