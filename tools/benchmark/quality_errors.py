"""How far pictures of each quality are from the reference, and how far off they say they are.

    quality_errors.py --umbrick build/release/tools/umbrick --work /tmp/benchmark [VOLUME.vdb TRANSFER ...]

For each volume with its transfer function (a preset or a file; the bundled ones when none is given) and each half-angle of the cone: the
RMSE of linear premultiplied RGB of a single picture of each quality, and of the mean of `--passes` passes of each, the error that
these print, and the ratio of that to the true one. The last lines count pictures of `high` that are worse than those of `normal`,
and estimates that are off by more than a factor of two. References are made once and kept in the folder.
Options that it does not know go to every picture.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

import exr

TOP = pathlib.Path(__file__).resolve().parents[2]
QUALITIES = ("draft", "normal", "high")


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def bundled(umbrick, work):
    """The volumes of assets/, converted where need be."""
    head = work / "head.vdb"
    if not head.exists():
        run(umbrick, "convert", TOP / "assets/headsq_256x256x94_uint16le.raw.gz", "--dims", 256, 256, 94, "--type", "u16",
            "--bits-stored", 15, "--spacing", 0.8, 0.8, 1.5, "-o", head)
    return [head, "ct-head", head, "ct-bone", TOP / "assets/densityAndHeat.vdb", "smoke"]


def rmse(picture, truth):
    return float(np.sqrt(np.mean((exr.read_rgba(picture) - exr.read_rgba(truth))[..., :3] ** 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="VOLUME TRANSFER", help="as many pairs as wanted [the bundled ones]")
    parser.add_argument("--umbrick", required=True, type=pathlib.Path, help="the program")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--size", default="128x128", help="of the pictures (128x128)")
    parser.add_argument("--theta", nargs="+", default=["30", "60", "80"], help="half-angles of the cone, degrees (30 60 80)")
    parser.add_argument("--qualities", nargs="+", default=QUALITIES, choices=QUALITIES)
    parser.add_argument("--passes", default="8", help="of the pictures whose estimate is looked at (8)")
    parser.add_argument("--directions", default="128", help="of the reference (128)")
    arguments, others = parser.parse_known_args()
    umbrick, work = arguments.umbrick.resolve(), arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    scenes = arguments.scenes or bundled(umbrick, work)
    if len(scenes) % 2:
        parser.error("each volume needs a transfer function")
    camera = ["--azimuth", "30", "--elevation", "20", "--size", arguments.size]

    print("| volume, transfer, theta | " + " | ".join(
        f"{quality}: single | {arguments.passes} passes | said | ratio" for quality in arguments.qualities) + " |")
    print("| --- " * (1 + 4 * len(arguments.qualities)) + "|")
    pictures = worse = off = 0
    for volume, transfer in zip(map(pathlib.Path, scenes[::2]), scenes[1::2]):
        for theta in arguments.theta:
            scene = [volume, "--tf", transfer, "--model", "cone", "--theta", theta, *camera]
            name = f"{volume.stem}-{pathlib.Path(transfer).stem}-{theta}-{arguments.size}"
            truth, picture, stats = work / f"{name}-truth.exr", work / "picture.exr", work / "stats.json"
            if not truth.exists():
                run(umbrick, "reference", *scene, "--directions", arguments.directions, "--tolerance", "2e-3", "--exr-pixel",
                    "float", "-o", truth)
            cells, single = [], {}
            for quality in arguments.qualities:
                options = [*scene, "--quality", quality, "--exr-pixel", "float", *others, "-o", picture, "--stats", stats]
                run(umbrick, "render", *options)
                single[quality] = rmse(picture, truth)
                run(umbrick, "render", *options, "--progressive", arguments.passes)
                true, said = rmse(picture, truth), json.loads(stats.read_text())["progressive"]["error"]
                ratio = said / true if said is not None else float("inf")
                cells += [f"{single[quality]:.4f}", f"{true:.4f}", f"{said:.4f}" if said is not None else "-", f"{ratio:.2f}"]
                pictures += 1
                off += not 0.5 <= ratio <= 2
            worse += single.get("high", 0) > single.get("normal", 1)
            print(f"| {volume.stem}, {pathlib.Path(transfer).stem}, {theta} | " + " | ".join(cells) + " |", flush=True)
    print(f"\nhigh is worse than normal in {worse} of {pictures // len(arguments.qualities)} scenes")
    print(f"estimates off by more than a factor of two: {off} of {pictures}")


if __name__ == "__main__":
    sys.exit(main())
