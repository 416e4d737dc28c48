#!/usr/bin/python3
"""What `umbrick convert` takes for one volume in many formats, beside cat(1) of the file and OpenVDB's copyFromDense.

    convert_formats.py --umbrick build/release/tools/umbrick --work /tmp/formats [--edge 512] [--rounds 3]

The volume is 16-bit, balls in 5 % of it on zeros, 512^3 unless said otherwise. Each way takes its turn in every round, from the page
cache; times are medians of the whole command, start and written .vdb included, memory is the peak of the process. copyFromDense is
called by pyopenvdb on 32-bit floats that are in memory already, pruned, and neither read nor written. Prints a table.
Needs Debian's python3-numpy, python3-openvdb and python3-h5py, gzip, xz and zstd.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import pathlib
import statistics
import struct
import subprocess
import sys
import time

import h5py
import numpy as np
import pyopenvdb


def balls(edge):
    """[z, y, x], as convert_speed.cpp makes them."""
    cell = edge / 4
    radius = cell * np.cbrt(0.05 * 3 / (4 * np.pi))
    at = np.arange(edge)
    off = np.fmod(at + 0.5, cell) - cell / 2
    out = np.empty((edge, edge, edge), np.uint16)
    ripple = at[:, None] * 5 + at[None, :] * 7
    for z in range(edge):
        r = np.sqrt(off[None, :]**2 + off[:, None]**2 + off[z]**2)
        out[z] = np.where(r < radius, 1000 + 3000 * (1 - r / radius) + (ripple + 3 * z) % 32, 0).astype(np.uint16)
    return out


def write(path, *parts):
    with open(path, "wb") as file:
        for part in parts:
            file.write(part)


def pack(tool, source, target):
    with open(target, "wb") as out:
        subprocess.run([*tool, "-c", source], stdout=out, check=True)


def nifti_header(edge):
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, edge, edge, edge, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 512, 16)  # 16-bit unsigned
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<ff", header, 108, 352, 1)
    header[344:348] = b"n+1\0"
    return bytes(header)


def make_files(work, edge):
    """Paths by name, each with the options it needs."""
    voxels = balls(edge)
    raw, dims = work / "v.raw", f"{edge} {edge} {edge}"
    write(raw, voxels.tobytes())
    nrrd = f"NRRD0004\ntype: uint16\ndimension: 3\nsizes: {dims}\nendian: little\nencoding: "
    write(work / "v.nrrd", nrrd.encode() + b"raw\n\n", voxels.tobytes())
    pack(["gzip", "-6"], raw, work / "v.raw.gz")
    write(work / "gzip.nrrd", nrrd.encode() + b"gzip\n\n", (work / "v.raw.gz").read_bytes())
    pack(["xz", "-1"], raw, work / "v.raw.xz")
    pack(["zstd", "-q"], raw, work / "v.raw.zst")
    write(work / "v.mhd", f"NDims = 3\nDimSize = {dims}\nElementType = MET_USHORT\nElementDataFile = v.raw\n".encode())
    write(work / "v.nii", nifti_header(edge), voxels.tobytes())
    pack(["gzip", "-6"], work / "v.nii", work / "v.nii.gz")
    np.save(work / "v.npy", voxels)
    with h5py.File(work / "v.h5", "w") as file:
        file.create_dataset("plain", data=voxels)
        file.create_dataset("packed", data=voxels, chunks=(16, 128, 128), compression="gzip", compression_opts=4)
    options = ["--dims", *dims.split(), "--type", "u16"]
    return voxels, {
        "raw": ([raw, *options], raw), "raw, gzip": ([work / "v.raw.gz", *options], work / "v.raw.gz"),
        "raw, xz": ([work / "v.raw.xz", *options], work / "v.raw.xz"),
        "raw, zstd": ([work / "v.raw.zst", *options], work / "v.raw.zst"),
        "NRRD": ([work / "v.nrrd"], work / "v.nrrd"), "NRRD, gzip": ([work / "gzip.nrrd"], work / "gzip.nrrd"),
        "MetaImage": ([work / "v.mhd"], raw), "NIfTI": ([work / "v.nii"], work / "v.nii"),
        "NIfTI, gzip": ([work / "v.nii.gz"], work / "v.nii.gz"), "NumPy": ([work / "v.npy"], work / "v.npy"),
        "HDF5": ([f"{work}/v.h5:/plain"], raw), "HDF5, chunks, gzip": ([f"{work}/v.h5:/packed"], work / "v.raw.gz")}


# A process counts the memory of the one it came from: this one is large.
RUN = """import os, subprocess, sys, time
begin = time.perf_counter()
_, status, used = os.wait4(subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL).pid, 0)
print(status, time.perf_counter() - begin, used.ru_maxrss / 1024)"""


def run(command):
    """Seconds and peak MB."""
    told = subprocess.run([sys.executable, "-c", RUN, *map(str, command)], stdout=subprocess.PIPE, check=True, text=True)
    status, seconds, peak = map(float, told.stdout.split())
    if status:
        sys.exit(f"convert_formats.py: failed: {' '.join(map(str, command))}")
    return seconds, peak


def copy_from_dense(floats):
    begin = time.perf_counter()
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(floats, tolerance=0)
    grid.prune()
    return time.perf_counter() - begin, grid.activeVoxelCount()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--umbrick", required=True, help="the program")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--edge", type=int, default=512, help="voxels (512)")
    parser.add_argument("--rounds", type=int, default=3, help="(3)")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    voxels, files = make_files(arguments.work, arguments.edge)
    megabytes, active = voxels.nbytes / 1e6, np.count_nonzero(voxels)
    floats = np.ascontiguousarray(voxels.transpose(2, 1, 0), np.float32)
    del voxels
    times = {name: [] for name in files}
    cats = {name: [] for name in files}
    peaks, dense = {}, []
    for _ in range(arguments.rounds):
        seconds, count = copy_from_dense(floats)
        if count != active:
            sys.exit(f"convert_formats.py: copyFromDense: expected {active} active voxels, found {count}")
        dense.append(seconds)
        for name, (command, file) in files.items():
            cats[name].append(run(["cat", file])[0])
            seconds, peaks[name] = run([arguments.umbrick, "convert", *command, "-o", arguments.work / "out.vdb"])
            times[name].append(seconds)
            found = pyopenvdb.read(str(arguments.work / "out.vdb"), "density").activeVoxelCount()
            if found != active:
                sys.exit(f"convert_formats.py: {name}: expected {active} active voxels, found {found}")
    print(f"{arguments.edge}^3, {100 * active / arguments.edge**3:.1f} % active, {megabytes:.0f} MB of voxels; "
          f"copyFromDense {statistics.median(dense):.2f} s")
    print("| format | file, MB | time, s | voxels, MB/s | of copyFromDense | of cat | peak, MB |\n| --- | --- | --- | --- | --- | --- | --- |")
    for name, (_, file) in files.items():
        took = statistics.median(times[name])
        print(f"| {name} | {file.stat().st_size / 1e6:.0f} | {took:.2f} | {megabytes / took:.0f} | "
              f"{took / statistics.median(dense):.2f} | {took / statistics.median(cats[name]):.1f} | {peaks[name]:.0f} |")


if __name__ == "__main__":
    main()
