#!/usr/bin/python3
"""Unlit volume rendering, side by side: umbrick against VTK's GPU and fixed-point CPU mappers, time and error.

All draw the same voxels with the same camera and the same transfer function, VTK at half-voxel sampling, umbrick by
the techniques and at the spacings that are asked for; slices on OSMesa, the others on the CPU. Errors are root mean squares over all pixels of linear premultiplied RGB (RGBA in
the second column) against a double-precision marcher at 16 steps a voxel. The renderers take turns, so that other load
on the machine meets all of them; the first frame of each turn, which uploads, is not counted.
VTK's pictures have 8 bits a channel, which adds about 0.001.

    emission_vs_vtk.py head  --raw headsq_256x256x94_uint16le.raw.gz --transfer assets/transfer/ct-head.json \\
                       --umbrick build/release/tools/umbrick --work /tmp/benchmark
    emission_vs_vtk.py smoke --raw smoke.raw --transfer smoke_transfer.json --umbrick ... --work ...

smoke.raw comes from make_smoke.py. Needs Debian's python3-numpy, python3-openvdb, python3-vtk9, xvfb and xauth."""
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
from reference_march import march

HERE = pathlib.Path(__file__).resolve().parent


def load_volume(arguments):
    """Voxels [z, y, x] with a border of zeros, and the voxel edges in world units."""
    if arguments.volume == "head":
        # Bit 15 flags connectivity and is no part of the value.
        return volumes.load_raw(arguments.raw, (256, 256, 94), "<u2", 0x7fff), (0.8, 0.8, 1.5)
    size = arguments.size
    return volumes.load_raw(arguments.raw, (size, size, size), "<f4"), (1.0, 1.0, 1.0)


def orbit_camera(voxels, spacing, azimuth, elevation, zoom, top, fov, width, height):
    """A camera that sees the bounding sphere of the voxels, then goes `zoom` times as near. @param top  +1 or -1: the
    end of the z axis that is up"""
    occupied = [np.flatnonzero(voxels.any(axes)) for axes in ((0, 1), (0, 2), (1, 2))]
    low = np.array([o[0] for o in occupied]) * spacing
    high = np.array([o[-1] for o in occupied]) * spacing
    centre, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    half = np.arctan(np.tan(np.radians(fov) / 2) * min(1, width / height))
    a, e = np.radians(azimuth), np.radians(elevation)
    to_eye = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), top * np.sin(e)])
    return {"eye": list(centre + to_eye * radius / np.sin(half) / zoom), "lookAt": list(centre), "up": [0, 0, top],
            "fov": fov, "width": width, "height": height}


def run(command):
    result = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}failed with {result.returncode}")


def run_vtk(kind, scene, frames, work):
    """-> frame times in ms, picture, name of the GL renderer"""
    output = work / f"vtk-{kind}"
    run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, HERE / "vtk_frames.py", kind,
         work / "scene.json", frames, output])
    with open(f"{output}.json") as file:
        stats = json.load(file)
    return stats["frames_ms"], np.load(f"{output}.npy"), stats["gl"]


def run_umbrick(program, how, extra, scene, frames, work, transfer):
    """-> frame times in ms, picture. The only place that knows umbrick's command line and statistics."""
    camera = scene["camera"]
    technique, _, spacing = how.rpartition(":")
    technique = technique or "slices"
    spacing, _, segments = spacing.partition("/")
    name = f"umbrick-{technique}-{spacing}-{segments or 1}"
    picture, stats = work / f"{name}.exr", work / f"{name}.json"
    run([program, "render", work / "volume.vdb", "--tf", transfer, "--eye", *camera["eye"], "--look-at",
         *camera["lookAt"], "--up", *camera["up"], "--fov", camera["fov"],
         "--size", f"{camera['width']}x{camera['height']}", "--model", "emission", "--spacing", spacing,
         "--segments", segments or 1, "--technique", technique,
         "--backend", "osmesa" if technique == "slices" else "cpu",
         "--repeat", frames + 1, "--exr-pixel", "float", *extra, "--stats", stats, "-o", picture])
    with open(stats) as file:
        return json.load(file)["frames_ms"][1:], exr.read_rgba(picture)


def reference(voxels, scene, work):
    """The truth, computed once for a scene."""
    key = {k: v for k, v in scene.items() if k != "voxelsPerSample"}
    path, key_path = work / "reference.npy", work / "reference.json"
    if path.exists() and key_path.exists() and json.loads(key_path.read_text()) == json.loads(json.dumps(key)):
        return np.load(path)
    print("marching the reference ...", file=sys.stderr)
    picture = march(voxels, scene["spacing"], scene["points"], scene["camera"])
    np.save(path, picture)
    key_path.write_text(json.dumps(key))
    return picture


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("volume", choices=["head", "smoke"])
    parser.add_argument("--raw", required=True, help="the voxels, as a raw file")
    parser.add_argument("--size", type=int, default=512, help="smoke: voxels along each edge (512)")
    parser.add_argument("--transfer", required=True, help="transfer function: JSON with \"points\"")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--umbrick", help="the program; without it only VTK is measured")
    parser.add_argument("--spacing", default="0.5", help="umbrick: technique (slices), spacing in voxels, and the segments of "
                        "a slab (1); several: 0.5,2/4,rays:0.5,shear-warp:1")
    parser.add_argument("--extra", default="", help="umbrick: more options, separated by spaces")
    parser.add_argument("--azimuth", type=float, default=30, help="deg (30)")
    parser.add_argument("--elevation", type=float, default=15, help="deg (15)")
    parser.add_argument("--zoom", type=float, default=1.3, help="1: the bounding sphere fills the picture (1.3)")
    parser.add_argument("--image", type=int, default=512, help="pixels along each edge (512)")
    parser.add_argument("--frames", type=int, default=3, help="counted frames in a turn (3)")
    parser.add_argument("--turns", type=int, default=3, help="of each renderer (3)")
    arguments = parser.parse_args()

    work = arguments.work
    work.mkdir(parents=True, exist_ok=True)
    voxels, spacing = load_volume(arguments)
    np.save(work / "voxels.npy", voxels)
    if arguments.umbrick:
        volumes.write_vdb(work / "volume.vdb", voxels, spacing)
    with open(arguments.transfer) as file:
        points = json.load(file)["points"]
    scene = {"voxels": str(work / "voxels.npy"), "raw": str(arguments.raw), "spacing": spacing, "points": points,
             "voxelsPerSample": 0.5,
             "camera": orbit_camera(voxels, np.array(spacing), arguments.azimuth, arguments.elevation, arguments.zoom,
                                    -1 if arguments.volume == "head" else 1,  # the scan begins at the crown
                                    30, arguments.image, arguments.image)}
    (work / "scene.json").write_text(json.dumps(scene))

    truth = reference(voxels, scene, work)
    write_png(work / "reference.png", truth)
    contenders = {"VTK GPU mapper": lambda: run_vtk("gpu", scene, arguments.frames, work),
                  "VTK fixed-point mapper": lambda: run_vtk("cpu", scene, arguments.frames, work)}
    for d in arguments.spacing.split(",") if arguments.umbrick else []:
        contenders[f"umbrick, {d}"] = lambda d=d: run_umbrick(
            arguments.umbrick, d, arguments.extra.split(), scene, arguments.frames, work, arguments.transfer)
    times, pictures, gl_names = {name: [] for name in contenders}, {}, set()
    for _ in range(arguments.turns):
        for name, render in contenders.items():
            elapsed, pictures[name], *gl = render()
            times[name] += elapsed
            gl_names.update(gl)

    renderer = gl_names.pop() if len(gl_names) == 1 else str(gl_names)
    print(f"{arguments.volume}, {arguments.image} x {arguments.image} pixels, {arguments.turns} x {arguments.frames} "
          f"frames, VTK on {renderer}")
    print(f"{'':28}{'median ms':>10}{'min':>9}{'max':>9}{'RMSE RGB':>10}{'RGBA':>9}{'largest':>9}{'x slower':>9}")
    fastest = min(statistics.median(t) for t in times.values())
    for name, elapsed in times.items():
        error = pictures[name] - truth
        median = statistics.median(elapsed)
        print(f"{name:28}{median:10.1f}{min(elapsed):9.1f}{max(elapsed):9.1f}"
              f"{np.sqrt(np.mean(error[..., :3]**2)):10.5f}{np.sqrt(np.mean(error**2)):9.5f}"
              f"{np.abs(error).max():9.4f}{median / fastest:9.2f}")
        write_png(work / (re.sub(r"[^A-Za-z0-9.]+", "-", name) + ".png"), pictures[name])


if __name__ == "__main__":
    main()
