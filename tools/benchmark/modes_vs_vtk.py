#!/usr/bin/python3
"""Isosurfaces and maxima, side by side: umbrick against VTK and OpenVDB's vdb_render, time and error.

All draw the bundled head with the same parallel camera, VTK at half-voxel sampling. A surface is white and lit by a headlight, whose
light comes from one direction in a parallel view, so that all mean the same by it; its error is the root mean square over all pixels of RGB
against `umbrick reference`. A maximum's error is that of the value, in shares of the largest one. VTK's pictures have 8
bits a channel, which adds about 0.001. vdb_render draws a level set of the same surface, which `umbrick convert --isosurface` makes; its shader
is another one, so that it has no error here. The renderers take turns, so that other load on the machine meets all of them; the first
frame of each turn is not counted, but for vdb_render, which makes one picture and times it itself.

    modes_vs_vtk.py --raw assets/headsq_256x256x94_uint16le.raw.gz --umbrick build/release/tools/umbrick --work /tmp/benchmark

Needs Debian's python3-numpy, python3-openvdb, python3-vtk9, xvfb and xauth, and libopenvdb-tools for vdb_render."""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys

import numpy as np

import exr
import volumes
from png import write_png

HERE = pathlib.Path(__file__).resolve().parent
SPACING = (0.8, 0.8, 1.5)
PHONG = (0.2, 0.8, 0.3, 20)


def run(command):
    result = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}failed with {result.returncode}")
    return result.stdout + result.stderr


def parallel_camera(voxels, azimuth, elevation, size):
    """Sees the bounding sphere of what is above a tenth of the largest value. The scan begins at the crown."""
    occupied = [np.flatnonzero((voxels > voxels.max() / 10).any(axes)) for axes in ((0, 1), (0, 2), (1, 2))]
    low, high = (np.array([o[end] for o in occupied]) * SPACING for end in (0, -1))
    centre, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    a, e = np.radians(azimuth), np.radians(elevation)
    to_eye = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), -np.sin(e)])
    return {"eye": list(centre + 2 * radius * to_eye), "lookAt": list(centre), "up": [0, 0, -1],
            "viewHeight": 1.5 * radius, "width": size, "height": size}


def mode_options(scene, mode):
    camera = scene["camera"]
    options = ["--eye", *camera["eye"], "--look-at", *camera["lookAt"], "--up", *camera["up"], "--orthographic",
               "--view-height", camera["viewHeight"], "--size", f"{camera['width']}x{camera['height']}",
               "--tf", scene["work"] + "/white.json", "--mode", mode, "--exr-pixel", "float"]
    if mode == "isosurface":
        options += ["--iso", scene["iso"], "--iso-colours", 1, 1, 1]
    return options


def picture_of(path, mode):
    return exr.read_rgba(path)[..., :3] if mode == "isosurface" else exr.read_channels(path, ["value"])


def umbrick(program, scene, mode, frames, more=()):
    work = pathlib.Path(scene["work"])
    output, stats = work / f"umbrick-{mode}.exr", work / f"umbrick-{mode}.json"
    run([program, "render", work / "volume.vdb", *mode_options(scene, mode), "--backend", "cpu", "--repeat", frames + 1,
         "--stats", stats, "-o", output, *more])
    with open(stats) as file:
        return json.load(file)["frames_ms"][1:], picture_of(output, mode)


def vtk(kind, scene, frames, largest):
    work = pathlib.Path(scene["work"])
    output = work / f"vtk-{kind}"
    run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, HERE / "vtk_frames.py", kind,
         work / "scene.json", frames, output])
    with open(f"{output}.json") as file:
        stats = json.load(file)
    picture = np.load(f"{output}.npy")[..., :3]
    return stats["frames_ms"], picture if kind == "iso" else picture[..., :1] * largest


def vdb_render(program, scene, frames):
    work, camera = pathlib.Path(scene["work"]), scene["camera"]
    eye, target = np.array(camera["eye"]), np.array(camera["lookAt"])
    times = []
    for _ in range(frames):
        text = run([program, work / "level_set.vdb", work / "vdb_render.png", "-camera", "ortho", "-frame",
                    camera["viewHeight"], "-translate", ",".join(f"{x:.6f}" for x in eye), "-lookat",
                    ",".join(f"{x:.6f}" for x in target), "-up", "0,0,-1", "-res",
                    f"{camera['width']}x{camera['height']}", "-v"])
        times.append(1000 * float(re.search(r"ray-tracing.*?completed in ([0-9.]+) sec", text, re.S).group(1)))
    return times, None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--raw", required=True, help="the head, as a raw file")
    parser.add_argument("--umbrick", required=True, help="the program")
    parser.add_argument("--vdb-render", help="OpenVDB's program; without it it is left out")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--iso", type=float, default=1150, help="value of the surface (1150, bone)")
    parser.add_argument("--azimuth", type=float, default=30, help="deg (30)")
    parser.add_argument("--elevation", type=float, default=15, help="deg (15)")
    parser.add_argument("--image", type=int, default=512, help="pixels along each edge (512)")
    parser.add_argument("--frames", type=int, default=3, help="counted frames in a turn (3)")
    parser.add_argument("--turns", type=int, default=3, help="of each renderer (3)")
    arguments = parser.parse_args()
    work = arguments.work
    work.mkdir(parents=True, exist_ok=True)
    # Bit 15 flags connectivity and is no part of the value.
    voxels = volumes.load_raw(arguments.raw, (256, 256, 94), "<u2", 0x7fff)
    np.save(work / "voxels.npy", voxels)
    volumes.write_vdb(work / "volume.vdb", voxels, SPACING)
    largest = float(voxels.max())
    points = [{"value": 0, "albedo": [1, 1, 1], "sigma_t": 0}, {"value": largest, "albedo": [1, 1, 1], "sigma_t": 1}]
    (work / "white.json").write_text(json.dumps({"points": points}))
    scene = {"voxels": str(work / "voxels.npy"), "spacing": SPACING, "points": points, "voxelsPerSample": 0.5,
             "iso": arguments.iso, "phong": PHONG, "work": str(work),
             "camera": parallel_camera(voxels, arguments.azimuth, arguments.elevation, arguments.image)}
    (work / "scene.json").write_text(json.dumps(scene))
    truth = {}
    for mode in ("isosurface", "mip"):
        run([arguments.umbrick, "reference", work / "volume.vdb", *mode_options(scene, mode), "-o", work / "truth.exr"])
        truth[mode] = picture_of(work / "truth.exr", mode)
    program, frames = arguments.umbrick, arguments.frames
    contenders = {("isosurface", "umbrick"): lambda: umbrick(program, scene, "isosurface", frames),
                  ("isosurface", "VTK GPU mapper"): lambda: vtk("iso", scene, frames, largest),
                  ("mip", "umbrick, 2 a voxel"): lambda: umbrick(program, scene, "mip", frames),
                  ("mip", "umbrick, 1 a voxel"): lambda: umbrick(program, scene, "mip", frames, ["--spacing", 1]),
                  ("mip", "VTK fixed-point mapper"): lambda: vtk("cpu-mip", scene, frames, largest),
                  ("mip", "VTK GPU mapper"): lambda: vtk("gpu-mip", scene, frames, largest)}
    if arguments.vdb_render:
        run([program, "convert", work / "volume.vdb", "-o", work / "level_set.vdb", "--isosurface", arguments.iso, "--force"])
        contenders[("isosurface", "vdb_render")] = lambda: vdb_render(arguments.vdb_render, scene, frames)
    times, pictures = {name: [] for name in contenders}, {}
    for _ in range(arguments.turns):
        for name, render in contenders.items():
            elapsed, pictures[name] = render()
            times[name] += elapsed
    print(f"{arguments.image} x {arguments.image} pixels, {arguments.turns} x {arguments.frames} frames")
    print(f"{'':12}{'':24}{'median ms':>10}{'min':>9}{'max':>9}{'RMSE':>10}")
    for name, elapsed in sorted(times.items()):
        mode, who = name
        error = ""
        if pictures[name] is not None:
            scale = largest if mode == "mip" else 1
            error = f"{np.sqrt(np.mean(((pictures[name] - truth[mode]) / scale) ** 2)):.5f}"
            shown = np.repeat(pictures[name] / scale, 3, 2) if mode == "mip" else pictures[name]
            write_png(work / (re.sub(r"[^A-Za-z0-9.]+", "-", f"{mode} {who}") + ".png"),
                      np.dstack([shown, np.ones(shown.shape[:2])]))
        print(f"{mode:12}{who:24}{statistics.median(elapsed):10.1f}{min(elapsed):9.1f}{max(elapsed):9.1f}{error:>10}")


if __name__ == "__main__":
    main()
