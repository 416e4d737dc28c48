# What the tests of the Python module share: the bundled CT in small, and the program beside the module.
# SPDX-License-Identifier: Apache-2.0
import gzip
import os
import pathlib
import subprocess

import numpy as np
import pytest

import umbrick

ASSETS = pathlib.Path(os.environ["UMBRICK_ASSETS"])
PROGRAM = os.environ.get("UMBRICK_PROGRAM", "")


@pytest.fixture(scope="session")
def assets():
    return ASSETS


@pytest.fixture(scope="session")
def ct():
    """The bundled CT, element [x, y, z]: every fourth voxel along x and y, every second along z."""
    with gzip.open(ASSETS / "headsq_256x256x94_uint16le.raw.gz") as file:
        whole = np.frombuffer(file.read(), "<u2").reshape(94, 256, 256) & 0x7FFF
    return np.ascontiguousarray(whole.transpose(2, 1, 0)[::4, ::4, ::2])


CT_SPACING = (3.2, 3.2, 3.0)  # mm


@pytest.fixture(scope="session")
def head(ct):
    return umbrick.Volume.open(ct, spacing=CT_SPACING)


@pytest.fixture(scope="session")
def head_file(ct, tmp_path_factory):
    """The same volume as a file, for the program."""
    path = tmp_path_factory.mktemp("head") / "head.vdb"
    umbrick.convert(ct, spacing=CT_SPACING, background=0).save(path)
    return path


@pytest.fixture(scope="session")
def program():
    """Runs the umbrick program and returns what it printed to stderr."""
    if not PROGRAM:
        pytest.skip("the umbrick program is not built")

    def run(*arguments, status=0):
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        return done.stderr

    return run


def ramp(shape=(7, 5, 3), dtype=np.float32):
    """An array without any symmetry, none of whose elements is 0: each is told from all others."""
    return (np.arange(np.prod(shape)).reshape(shape) + 1).astype(dtype)


def one_line(error):
    """Returns the message of an exception, which is one line."""
    text = str(error.value)
    assert text and "\n" not in text
    return text
