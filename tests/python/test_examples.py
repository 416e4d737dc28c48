# The examples run as they stand, on the bundled data.
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import umbrick

EXAMPLES = pathlib.Path(os.environ["UMBRICK_EXAMPLES"])


def run(name, tmp_path, *arguments):
    done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], cwd=tmp_path, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_every_example_is_tested():
    by_hand = {"test_vtk_against_kit.py"}  # needs VTK
    assert {path.name for path in EXAMPLES.glob("*.py")} - by_hand == {
        "ct_to_picture.py", "simulation_to_vdb.py", "transfer_sweep.py", "turntable.py"}


def test_ct_to_picture(tmp_path, assets):
    run("ct_to_picture.py", tmp_path, assets / "headsq_256x256x94_uint16le.raw.gz", "head.png", "--size", 96)
    assert umbrick.Picture.open(tmp_path / "head.png").colour[..., 3].mean() > 0.1


def test_simulation_to_vdb(tmp_path):
    run("simulation_to_vdb.py", tmp_path, "plume.vdb", "--cells", 32)
    volume = umbrick.Volume.open(tmp_path / "plume.vdb")
    info = volume.info()
    assert info["dims"][2] > info["dims"][0] > 4 and 0 < info["max"] <= 1


def test_turntable(tmp_path, assets):
    run("turntable.py", tmp_path, assets / "densityAndHeat.vdb", "turn_%03d.png", "--frames", 3, "--size", 48)
    pictures = [umbrick.Picture.open(tmp_path / f"turn_{i:03}.png").colour for i in range(3)]
    assert all(picture[..., 3].max() > 0.05 for picture in pictures)
    assert not np.array_equal(pictures[0], pictures[1])


def test_transfer_sweep(tmp_path, assets):
    pytest.importorskip("matplotlib")
    printed = run("transfer_sweep.py", tmp_path, assets / "densityAndHeat.vdb", "sweep.png", "--size", 32, "--steps", 3)
    assert (tmp_path / "sweep.png").read_bytes().startswith(b"\x89PNG")
    errors = [float(line.split()[-1]) for line in printed.splitlines()[1:]]
    assert len(errors) >= 3 and all(0 <= error < 0.2 for error in errors)
