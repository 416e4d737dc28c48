#!/usr/bin/python3
"""What the reference costs: rays and samples per second and core, and what skipping empty space gives.

Makes soft balls that fill a given share of a box and runs `umbrick reference` on them and on any scene given: with and
without skipping in turns, the median of the ratios of the times of integration. Samples are evaluations of V (quadrature)
or tentative collisions (Monte Carlo). Needs Debian's python3-numpy and python3-openvdb."""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np

from volumes import write_vdb


def make_balls(size, occupancy, seed=5):
    """Balls of radius 6 to 14 voxels, value 1 at the centre and 0 at the surface, until so many voxels are above 0."""
    random = np.random.default_rng(seed)
    volume = np.zeros((size, size, size), np.float32)
    while np.count_nonzero(volume) < occupancy * volume.size:
        radius = random.uniform(6, 14)
        centre = random.uniform(radius + 1, size - radius - 1, 3)
        low = np.floor(centre - radius).astype(int)
        high = np.ceil(centre + radius).astype(int) + 1
        axes = [np.arange(low[i], high[i]) - centre[i] for i in range(3)]
        square = axes[0][:, None, None]**2 + axes[1][None, :, None]**2 + axes[2][None, None, :]**2
        part = volume[low[0]:high[0], low[1]:high[1], low[2]:high[2]]
        np.maximum(part, 1 - np.sqrt(square) / radius, out=part)
    return np.maximum(volume, 0)


TRANSFER = {"points": [{"value": 0, "albedo": [1, 0.9, 0.8], "sigma_t": 0},
                       {"value": 1, "albedo": [0.6, 0.7, 1], "sigma_t": 0.3}]}


def run(program, scene, options, folder):
    stats = folder / "stats.json"
    subprocess.run([program, "reference", *scene, *options, "-o", folder / "picture.exr", "--stats", stats], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads(stats.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/tools/umbrick")
    parser.add_argument("--scene", action="append", default=[], help="a scene file to measure as well; may be repeated")
    parser.add_argument("--box", type=int, default=256, help="voxels along the edge of the box of balls (256)")
    parser.add_argument("--occupancy", type=float, default=0.03, help="share of its voxels above 0 (0.03)")
    parser.add_argument("--size", type=int, default=128, help="pixels along the edge of the pictures (128)")
    parser.add_argument("--repeats", type=int, default=5, help="pairs with and without skipping (5)")
    arguments = parser.parse_args()
    cores = os.cpu_count()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_vdb(folder / "balls.vdb", make_balls(arguments.box, arguments.occupancy), (1, 1, 1))
        (folder / "balls.json").write_text(json.dumps(TRANSFER))
        scenes = {f"balls, {100 * arguments.occupancy:g} %": [folder / "balls.vdb", "--tf", folder / "balls.json"]}
        scenes.update({path: [path] for path in arguments.scene})
        print(f"{cores} cores, load {os.getloadavg()[0]:.1f}, {arguments.size} x {arguments.size}")
        print(f"{'scene':24} {'model':10} {'integrator':12} {'rays/s/core':>12} {'cells/s/core':>13} {'samples/s/core':>15}"
              f" {'no skipping':>12}")
        for label, scene in scenes.items():
            for model in ("emission", "cone", "ambient"):
                for integrator in ("quadrature", "monte-carlo"):
                    # A picture of emission is done in no time: more pixels make it measurable.
                    edge = arguments.size * (4 if model == "emission" and integrator == "quadrature" else 1)
                    options = ["--model", model, "--integrator", integrator, "--size", f"{edge}x{edge}",
                               "--directions", "64", "--tolerance", "1e-3", "--samples", "64"]
                    ratios, rates = [], []
                    for _ in range(arguments.repeats):
                        fast = run(arguments.program, scene, options, folder)
                        slow = run(arguments.program, scene, [*options, "--no-skipping"], folder)
                        seconds = fast["time_ms"]["integrate"] / 1000 * cores
                        ratios.append(slow["time_ms"]["integrate"] / fast["time_ms"]["integrate"])
                        rays = fast["eye_rays"] + fast["light_rays"]
                        rates.append([rays / seconds, fast["cells"] / seconds, fast["samples"] / seconds])
                    rays, cells, samples = np.median(np.array(rates), axis=0)
                    print(f"{label[:24]:24} {model:10} {integrator:12} {rays:12.3g} {cells:13.3g} {samples:15.3g}"
                          f" {statistics.median(ratios):11.1f}x", flush=True)


if __name__ == "__main__":
    main()
