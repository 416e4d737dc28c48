"""What a picture costs and how exact it is: emission and cone with and without culling and early rejection, and the variants of
the cone model against each other.

    render_costs.py volume.vdb --tf ct-head --umbrick build/release/tools/umbrick --work /tmp/benchmark [--eye 0 0 0 ...]

The variants take turns, so that other load on the machine meets all of them; times are medians, as a ratio to emission.
Differences are root mean square and largest over linear premultiplied RGBA. Options that it does not know go to every render.
Needs Debian's python3-numpy.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import pathlib
import statistics
import subprocess

import numpy as np

import exr

EXACT = ["--saturation", "0"]
CONE = ["--model", "cone", "--method", "dos", "--theta", "60", "--footprint", "3"]
# name: options, the variant that its picture is compared with
VARIANTS = {
    "emission": ([], "emission, d / 16"),
    "emission, no rejection": (EXACT, "emission"),
    "emission, no culling": (["--no-culling"], "emission"),
    "emission, neither": (EXACT + ["--no-culling"], "emission"),
    "cone": (CONE, "cone, no rejection"),
    "cone, no rejection": (CONE + EXACT, None),
    "cone, no culling": (CONE + ["--no-culling"], "cone"),
    "cone, neither": (CONE + EXACT + ["--no-culling"], "cone, no rejection"),
    "cone, two passes": (CONE + EXACT + ["--passes", "2"], "cone, no rejection"),
    "cone, algorithm 2": (CONE + EXACT + ["--algorithm", "2"], "cone, no rejection"),
    "cone, 16-bit occlusion": (CONE + EXACT + ["--occlusion-bits", "16"], "cone, no rejection"),
    "cone, 16-bit eye": (CONE + EXACT + ["--eye-bits", "16"], "cone, no rejection"),
    "cone, 16 bit both": (CONE + EXACT + ["--eye-bits", "16", "--occlusion-bits", "16"], "cone, no rejection"),
}


def render(program, volume, transfer, work, name, options, frames):
    """-> frame times without the first, ms; statistics; picture."""
    stem = work / name.replace(" ", "_").replace("/", "")
    picture, stats = stem.with_suffix(".exr"), stem.with_suffix(".json")
    subprocess.run([program, "render", volume, "--tf", transfer, *options, "--repeat", str(frames + 1), "--exr-pixel", "float",
                    "--stats", stats, "-o", picture], check=True, stdout=subprocess.DEVNULL)
    statistics_read = json.loads(stats.read_text())
    return statistics_read["frames_ms"][1:], statistics_read, exr.read_rgba(picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("volume")
    parser.add_argument("--tf", required=True, help="transfer function")
    parser.add_argument("--umbrick", required=True, help="the program")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--spacing", type=float, default=0.5, help="of the slices, voxels (0.5)")
    parser.add_argument("--frames", type=int, default=2, help="counted frames in a turn (2)")
    parser.add_argument("--turns", type=int, default=3, help="of each variant (3)")
    arguments, others = parser.parse_known_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    fixed = (arguments.umbrick, arguments.volume, arguments.tf, arguments.work)
    common = ["--spacing", str(arguments.spacing), *others]
    times, stats, pictures = {name: [] for name in VARIANTS}, {}, {}
    for _ in range(arguments.turns):
        for name, (options, _) in VARIANTS.items():
            elapsed, stats[name], pictures[name] = render(*fixed, name, common + options, arguments.frames)
            times[name] += elapsed
    fine = ["--spacing", str(arguments.spacing / 16), *others, *EXACT]
    pictures["emission, d / 16"] = render(*fixed, "fine", fine, 0)[2]

    base = statistics.median(times["emission"])
    print(stats["emission"]["renderer"])
    print(f"{stats['emission']['slices']} slices, {stats['emission']['bricks']['visible']} of "
          f"{stats['emission']['bricks']['all']} bricks visible")
    print(f"{'':26}{'median ms':>10}{'x emission':>11}{'fragments':>11}{'RMSE':>10}{'largest':>10}  against")
    for name, (_, other) in VARIANTS.items():
        line = f"{name:26}{statistics.median(times[name]):10.0f}{statistics.median(times[name]) / base:11.2f}"
        line += f"{stats[name]['fragments_shaded'] / 1e6:10.2f}M"
        if other:
            error = np.abs(pictures[name] - pictures[other])
            line += f"{np.sqrt((error ** 2).mean()):10.1e}{error.max():10.1e}  {other}"
        print(line)


if __name__ == "__main__":
    main()
