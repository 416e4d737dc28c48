"""What a picture of occlusion costs by each method, and how far it is from the reference.

    method_costs.py scene.json --umbrick build/release/tools/umbrick --work /tmp/benchmark --through 314.5 [--size 256x256 ...]

Costs are CPU time (user and system) of a frame, the difference of a run of many frames and a run of one, over that of `emission`
in 256 slices, which takes turns with them: other load on the machine hardly touches them. `--through` is how many voxels deep the volume is along the view
axis: a row of the table in N slices has slices N times closer. Errors are the RMSE of linear premultiplied RGB against
`umbrick reference` (made once, kept in the folder). Prints a table; writes costs.dat and, with Debian's gnuplot, costs.svg there.
Options that it does not know go to every picture.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

DOS = [([n, "--method", "dos"], 0) for n in (64, 128, 256, 512, 1024)]
DOS_2 = [([n, "--method", "dos", "--algorithm", "2"], 1) for n in (64, 128, 256, 512, 1024)]
ORDINATES = [([n, "--method", "ordinates", "--directions", k, "--segments", s], 2)
             for n, k, s in ((12, 4, 1), (16, 4, 1), (16, 4, 4), (24, 6, 2), (32, 8, 4), (64, 8, 4), (64, 8, 8), (128, 16, 4), (256, 16, 2))]
TITLES = ["dos, Algorithm 3", "dos, Algorithm 2", "ordinates"]
PLOT = """set terminal svg size 860,470 enhanced font 'sans,13' background '#ffffff'
set output 'costs.svg'
set logscale xy
set xtics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20)
set ytics (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
set grid lc rgb '#dddddd'
set xlabel 'CPU time of a frame, emission in 256 slices = 1'
set ylabel 'RMSE of linear premultiplied RGB'
set key bottom left
plot """ + ", ".join(
    f"'costs.dat' index {i} using 1:2 with linespoints lw 2 ps 0.8 pt {symbol} lc rgb '{colour}' title '{title}'"
    for i, (symbol, colour, title) in enumerate(zip((7, 5, 9), ("#0072b2", "#d55e00", "#009e73"), TITLES)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="a scene or a volume")
    parser.add_argument("--umbrick", required=True, help="the program")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for what is made on the way")
    parser.add_argument("--through", required=True, type=float, help="voxels")
    parser.add_argument("--theta", default="60", help="half-angle of the cone, degrees (60)")
    parser.add_argument("--frames", type=int, default=4, help="that a cost is the mean of (4)")
    parser.add_argument("--directions", default="128", help="of the reference (128)")
    arguments, others = parser.parse_known_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    picture, truth = work / "picture.exr", work / f"truth_{arguments.theta}.exr"
    cone = ["--model", "cone", "--theta", arguments.theta]

    def seconds(slices, options, frames):
        child = subprocess.Popen([arguments.umbrick, "render", arguments.scene, *others, *map(str, options), "--spacing",
                                  str(arguments.through / slices), "--repeat", str(frames), "-o", picture],
                                 stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        if status:
            sys.exit(f"method_costs.py: {options}: the program failed")
        return used.ru_utime + used.ru_stime

    def cost(slices, options):
        return (seconds(slices, options, 1 + arguments.frames) - seconds(slices, options, 1)) / arguments.frames

    if not truth.exists():
        subprocess.run([arguments.umbrick, "reference", arguments.scene, *others, *cone, "--directions", arguments.directions,
                        "--tolerance", "2e-3", "-o", truth], check=True, stdout=subprocess.DEVNULL)
    def baseline():
        return cost(256, ["--model", "emission"])

    before = baseline()
    print(f"emission in 256 slices: {1000 * before:.0f} ms of CPU time")
    print("| method | slices | options | cost | error |\n| --- | --- | --- | --- | --- |")
    series = [[], [], []]
    for (slices, *options), method in DOS + DOS_2 + ORDINATES:
        own = cost(slices, [*cone, *options])
        compared = subprocess.run([arguments.umbrick, "compare", picture, truth, "--layer", "RGBA", "--json"],
                                  stdout=subprocess.PIPE, check=True)
        error = json.loads(compared.stdout)["layers"][0]["rmse_rgb"]
        after = baseline()
        ratio, before = 2 * own / (before + after), after
        series[method].append((ratio, error))
        print(f"| {TITLES[method]} | {slices} | {' '.join(map(str, options[2:]))} | {ratio:.2f} | {error:.4f} |", flush=True)
    (work / "costs.dat").write_text("\n\n".join("".join(f"{x} {y}\n" for x, y in points) for points in series))
    if shutil.which("gnuplot"):
        subprocess.run(["gnuplot"], input=PLOT.encode(), cwd=work, check=True)


if __name__ == "__main__":
    main()
