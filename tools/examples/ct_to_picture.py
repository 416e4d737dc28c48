#!/usr/bin/env python3
# A CT file to a picture: ct_to_picture.py assets/headsq_256x256x94_uint16le.raw.gz head.png
# SPDX-License-Identifier: Apache-2.0
"""Renders a CT with directional occlusion, and says what was chosen and how far off the picture is."""
import argparse

import umbrick

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("input", help="any volume; of the bundled raw file the layout is known")
parser.add_argument("output", help=".png or .exr")
parser.add_argument("--size", type=int, default=512, help="of the picture, pixels [512]")
arguments = parser.parse_args()

# A file with a header needs none of this.
raw = {}
if "headsq" in arguments.input:
    raw = dict(dims=(256, 256, 94), type="u16", bits_stored=15, spacing=(0.8, 0.8, 1.5))
volume = umbrick.Volume.open(arguments.input, **raw)
print(volume)

# Nobody names a transfer function: one that fits CT numbers is chosen.
picture = umbrick.render(volume, model="cone", theta=60, size=(arguments.size, arguments.size))
print("chosen:", ", ".join(f"{name}={value}" for name, value in picture.chosen.items()))
print("since:", "; ".join(picture.reasons))
print(f"drawn in {picture.stats['ms']:.0f} ms by {picture.stats['engine']}")
picture.save(arguments.output)
