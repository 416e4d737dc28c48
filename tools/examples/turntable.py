#!/usr/bin/env python3
# Pictures from all around: turntable.py assets/densityAndHeat.vdb turn_%03d.png
# SPDX-License-Identifier: Apache-2.0
"""Turns a camera around a volume. One renderer lives all the time, so that only the first picture uploads anything."""
import argparse

import umbrick

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("input", help="any volume")
parser.add_argument("output", help="names of the pictures, with a number: turn_%%03d.png")
parser.add_argument("--frames", type=int, default=36, help="pictures of a whole turn [36]")
parser.add_argument("--size", type=int, default=256, help="of a picture, pixels [256]")
arguments = parser.parse_args()

volume = umbrick.Volume.open(arguments.input)
renderer = umbrick.Renderer(volume, model="cone", size=(arguments.size, arguments.size), elevation=20)
for frame in range(arguments.frames):
    picture = renderer.set(azimuth=360 * frame / arguments.frames).render()
    picture.save(arguments.output % frame)
    print(f"{arguments.output % frame}: {picture.stats['ms']:.0f} ms, {picture.stats['uploaded_bricks']} bricks uploaded")
