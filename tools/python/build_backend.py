# What pip calls to build the package (PEP 517): CMake does the work, and this packs what it installs as a wheel.
# It needs nothing beyond Python itself, since Debian 12 has no scikit-build-core.
# SPDX-License-Identifier: Apache-2.0
"""Builds a wheel of umbrick by CMake. Options: pip install --config-settings=build=FOLDER --config-settings=jobs=N."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent


def _version():
    text = (TOP / "CMakeLists.txt").read_text()
    return re.search(r"project\(umbrick VERSION ([0-9.]+)", text).group(1)


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[^a-zA-Z0-9]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def _metadata():
    return (f"Metadata-Version: 2.1\nName: umbrick\nVersion: {_version()}\n"
            "Summary: Sparse volumes: convert, brick, render, check\nLicense: Apache-2.0\n"
            "Requires-Python: >=3.9\nRequires-Dist: numpy\n")


def _run(*command):
    subprocess.run([str(word) for word in command], check=True)


def _build(build, jobs):
    """Builds the module and returns the folder that holds the package."""
    generator = ["-G", "Ninja"] if not (build / "CMakeCache.txt").exists() else []
    _run("cmake", "-S", TOP, "-B", build, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DUMBRICK_TESTS=OFF",
         "-DUMBRICK_TOOLS=OFF", "-DUMBRICK_CCACHE=ON", f"-DPython_EXECUTABLE={sys.executable}",
         "-DUMBRICK_PYTHON_DIR=.")
    _run("cmake", "--build", build, "--target", "umbrick_python", *(["-j", jobs] if jobs else []))
    root = build / "wheel"
    _run("cmake", "--install", build, "--component", "python", "--strip", "--prefix", root)
    if not list((root / "umbrick").glob("_core.*")):
        raise RuntimeError("umbrick: the module was not built; CMake says above what is missing")
    return root


def _record(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    with tempfile.TemporaryDirectory(prefix="umbrick-") as folder:
        build = pathlib.Path(settings.get("build", folder)).resolve()
        root = _build(build, settings.get("jobs", os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL")))
        info = f"umbrick-{_version()}.dist-info"
        files = {str(path.relative_to(root)): path.read_bytes()
                 for path in sorted(root.rglob("*")) if path.is_file()}
        files[f"{info}/METADATA"] = _metadata().encode()
        files[f"{info}/LICENSE"] = (TOP / "LICENSE").read_bytes()
        files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: umbrick\nRoot-Is-Purelib: false\n"
                                  f"Tag: {_tag()}\n").encode()
        record = "".join(_record(name, data) for name, data in files.items()) + f"{info}/RECORD,,\n"
        files[f"{info}/RECORD"] = record.encode()
        wheel = f"umbrick-{_version()}-{_tag()}.whl"
        with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in files.items():
                archive.writestr(name, data)
    return wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = pathlib.Path(metadata_directory) / f"umbrick-{_version()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata())
    return info.name


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("umbrick: a source distribution is the whole checkout: install from that")


def get_requires_for_build_wheel(config_settings=None):
    return []
