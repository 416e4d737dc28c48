# Volumes: opened, converted, looked into and saved.
# SPDX-License-Identifier: Apache-2.0
"""Volumes: opened, converted, looked into and saved."""
import os
import tempfile
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._common import given, is_array, tell, warn

Progress = Callable[[float, str], Any]
Source = Union[str, "os.PathLike[str]", np.ndarray]


def _array_of(source):
    """Returns an array and the keywords that it brings: an image of nibabel has an affine matrix and lies in RAS."""
    if hasattr(source, "dataobj") and hasattr(source, "affine"):
        place = {} if source.affine is None else {"affine": source.affine, "space": "ras", "length_unit": "mm"}
        return np.asanyarray(source.dataobj), place
    return np.asanyarray(source), {}


class Volume:
    """A sparse volume in memory: a grid of 32-bit floats with its place in the world.

    Made by `Volume.open`, `umbrick.convert` or `Volume.from_pyopenvdb`. It does not change, and threads may share it.

    Index and arrays: voxel (x, y, z) has its centre at `affine @ (x, y, z, 1)` in the world, and is element [x, y, z]
    of `array()`, as in pyopenvdb and nibabel.
    """

    __slots__ = ("_handle",)

    def __init__(self, handle: "_core.Volume"):
        self._handle = handle

    @classmethod
    def open(
        cls,
        source: Source,
        *,
        grid: Optional[str] = None,
        emission_grid: Optional[str] = None,
        component: Union[None, int, str] = None,
        frame: Optional[int] = None,
        spacing: Optional[Sequence[float]] = None,
        origin: Optional[Sequence[float]] = None,
        affine: Any = None,
        axes: Optional[str] = None,
        length_unit: Optional[str] = None,
        space: Optional[str] = None,
        series: Union[None, int, str] = None,
        where: Optional[Sequence[str]] = None,
        dims: Optional[Sequence[int]] = None,
        type: Optional[str] = None,
        endian: Optional[str] = None,
        header_bytes: Optional[int] = None,
        bits_stored: Optional[int] = None,
        beside_only: Optional[bool] = None,
        progress: Optional[Progress] = None,
    ) -> "Volume":
        """Opens a volume to look at it, as `umbrick render` does: beyond its voxels lies what lies at its border.

        source       path of a volume of any format that `umbrick convert` reads, of a .vdb or .nvdb, of numbered files
                     (frame_%04d.nrrd: the first); or an array of two or three axes, behind which may stand one of 1 to
                     4 components; or an image of nibabel, whose affine matrix it keeps
        grid         of a file of grids: "name" or "name[1]"
        emission_grid  of a file of grids: the one that emits light beside it, "name", or "auto": the first that is above
                     0 somewhere of "temperature", "temp", "heat", "flame", "flames", "fire", "burn"
        component    of voxels of several numbers: 0, 1, ..., "x", "r", ... or "magnitude"
        frame        of a file of several volumes, counted from 0; of numbered files the number
        spacing      world units between voxel centres along x, y, z; of sources that state none [1, 1, 1]
        origin       world position of the centre of voxel (0, 0, 0); of the same sources [0, 0, 0]
        affine       of an array in place of both: 4 x 4, takes an index (x, y, z, 1) to the world
        axes         of an array: "xyz", element [x, y, z], or "zyx", element [z, y, x]; the order in memory (C or
                     Fortran) does not matter, and no copy is made of any
        length_unit  of an array: unit of the world, "mm", "um", ...
        space        of an array: which way the axes of the world point, "lps" or "ras"
        series, where                                          of DICOM
        dims, type, endian, header_bytes, bits_stored          of headerless raw: voxels along x (fastest), y, z; "u8" ...
        beside_only  refuse a header that names files outside of its folder
        progress     is called with the share that is done, in [0, 1], and the step; what it raises ends the work

        Raises IoError, InvalidArgument, OutOfMemory.
        """
        if hasattr(source, "dataobj") or is_array(source):
            array, place = _array_of(source)
            options = {**place, **given(spacing=spacing, origin=origin, affine=affine, axes=axes, component=component,
                                        length_unit=length_unit, space=space)}
            _refuse("Volume.open", "files", grid=grid, emission_grid=emission_grid, frame=frame, series=series, where=where, dims=dims, type=type,
                    endian=endian, header_bytes=header_bytes, bits_stored=bits_stored, beside_only=beside_only)
            handle = _core.open_array(array, options, progress)
        else:
            options = given(grid=grid, emission_grid=emission_grid, component=component, frame=frame, spacing=spacing,
                            origin=origin, series=series, where=where, dims=dims, type=type, endian=endian, header_bytes=header_bytes,
                            bits_stored=bits_stored, beside_only=beside_only)
            _refuse("Volume.open", "arrays", affine=affine, axes=axes, length_unit=length_unit, space=space)
            handle = _core.open_file(_path_of(source), options, progress)
        tell(handle.source, handle.notes)
        return cls(handle)

    @property
    def name(self) -> str:
        """Name of the grid, "density" where nobody gave another one."""
        return self._handle.name

    @property
    def source(self) -> str:
        """What the volume was made of: a path, or "array of (64, 32, 16) float32"."""
        return self._handle.source

    @property
    def unit(self) -> str:
        """Unit of the values, "HU" for one; empty where it is not known."""
        return self._handle.unit

    @property
    def affine(self) -> np.ndarray:
        """4 x 4 float64: takes the index (x, y, z, 1) of a voxel to its centre in the world."""
        return self._handle.affine

    @property
    def box(self) -> Tuple[Tuple[int, int, int], Tuple[int, int, int]]:
        """First and last index (x, y, z) of the active voxels, both included."""
        return self._handle.box

    @property
    def notes(self) -> List[str]:
        """What was chosen, guessed or left out, a line each."""
        return self._handle.notes

    @property
    def losses(self) -> Dict[str, Any]:
        """What a conversion lost: max_error and rms_error in grid units, exact over all voxels; clipped_voxels,
        non_finite, ... Empty of a volume that was opened."""
        return dict(self._handle.losses)

    def info(self, bins: int = 16) -> Dict[str, Any]:
        """Returns what the grid holds: dims, box, active_voxels, min, max, histogram (of `bins` equal bins over active
        values), background, voxel_size and world_bounds (world units), unit, memory_bytes, metadata."""
        return self._handle.info(bins)

    def array(self, box: Optional[Sequence[Sequence[int]]] = None) -> np.ndarray:
        """Returns the voxels of a box as float32, element [x - x0, y - y0, z - z0], in Fortran order.

        box  first and last index, both included: ((x0, y0, z0), (x1, y1, z1)); None: `self.box`. Beyond what is
             stored, voxels have the background.

        Raises InvalidArgument, OutOfMemory.
        """
        return self._handle.array(box)

    def save(
        self,
        path: Union[str, "os.PathLike[str]"],
        *,
        codec: Optional[str] = None,
        quantise: Union[None, int, str] = None,
        max_error: Optional[float] = None,
        progress: Optional[Progress] = None,
    ) -> Dict[str, Any]:
        """Writes a .vdb, .nvdb, .nrrd or .mhd, whole or not at all.

        codec      of a .vdb: "blosc", "zip" or "none" ["blosc"]
        quantise   of a .nvdb: bits of a value, 4, 8, 16, or "n": as few as keep max_error [32-bit floats]
        max_error  of quantise "n", grid units

        Returns the bytes that were written, and the largest error that quantising made, grid units.
        Raises IoError, InvalidArgument.
        """
        done = self._handle.save(os.fspath(path), given(codec=codec, quantise=quantise, max_error=max_error), progress)
        warn(done.pop("notes"), os.fspath(path))
        return done

    def to_pyopenvdb(self) -> Any:
        """Returns the grid as a FloatGrid of pyopenvdb (Debian: python3-openvdb).

        It goes through a .vdb in a temporary folder: two modules share no objects of C++ safely.

        Raises ImportError where pyopenvdb is not installed.
        """
        vdb = _pyopenvdb()
        with tempfile.TemporaryDirectory(prefix="umbrick-") as folder:
            path = os.path.join(folder, "grid.vdb")
            self._handle.save(path, {"codec": "none"}, None)
            return vdb.read(path, self.name)

    @classmethod
    def from_pyopenvdb(cls, grid: Any) -> "Volume":
        """Takes a scalar grid of pyopenvdb, by the same way as `to_pyopenvdb`.

        Raises InvalidArgument for grids of other values, and ImportError where pyopenvdb is not installed.
        """
        vdb = _pyopenvdb()
        with tempfile.TemporaryDirectory(prefix="umbrick-") as folder:
            path = os.path.join(folder, "grid.vdb")
            vdb.write(path, grids=[grid])
            return cls(_core.open_file(path, {}, None))

    def __repr__(self) -> str:
        (x0, y0, z0), (x1, y1, z1) = self.box
        return f"<umbrick.Volume {self.name!r} of {self.source}, {x1 - x0 + 1} x {y1 - y0 + 1} x {z1 - z0 + 1} voxels>"


def convert(
    source: Source,
    *,
    spacing: Optional[Sequence[float]] = None,
    origin: Optional[Sequence[float]] = None,
    affine: Any = None,
    axes: Optional[str] = None,
    name: Optional[str] = None,
    unit: Optional[str] = None,
    length_unit: Optional[str] = None,
    space: Optional[str] = None,
    background: Union[None, float, str] = None,
    tolerance: Optional[float] = None,
    threshold: Optional[float] = None,
    clip_below: Optional[float] = None,
    range: Optional[Sequence[float]] = None,
    half: Optional[bool] = None,
    step: Optional[float] = None,
    max_error: Optional[float] = None,
    mask: Union[None, str, "os.PathLike[str]"] = None,
    crop: Optional[Sequence[Sequence[int]]] = None,
    resample: Union[None, float, Sequence[float]] = None,
    isosurface: Optional[float] = None,
    half_width: Optional[float] = None,
    component: Union[None, int, str] = None,
    frame: Optional[int] = None,
    grid: Optional[str] = None,
    series: Union[None, int, str] = None,
    where: Optional[Sequence[str]] = None,
    override: Optional[bool] = None,
    strict: Optional[bool] = None,
    beside_only: Optional[bool] = None,
    dims: Optional[Sequence[int]] = None,
    type: Optional[str] = None,
    endian: Optional[str] = None,
    header_bytes: Optional[int] = None,
    bits_stored: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Volume:
    """Makes a sparse volume of a file or an array: the grid that `umbrick convert` writes with the same options.

    The keywords are those of the command line with _ for -. Source, spacing, origin, affine, axes and what tells how a
    file is read are as in `Volume.open`; space and length_unit also bring the world of a file to another one. In
    addition, in grid units where it is about values:

    name        of the grid ["density"]
    unit        of the values, kept in the metadata
    background  value of what is left out, or "auto": the value that most voxels on the faces of the volume have [0]
    tolerance   leave out voxels this close to the background and merge what is this close [0]
    threshold   voxels at and below this value become background; clip_below: below it; range: beyond (low, high)
    half, step  round values to 16-bit floats, or to multiples of a step
    max_error   no voxel that is kept is off by more: picks tolerance, half floats and steps
    mask        path of a volume: voxels where it is 0 become background
    crop        only the voxels from the first to the last index, both included: ((x0, y0, z0), (x1, y1, z1)). They stay
                where they are in the world, and are counted from 0 again
    resample    spacing of the voxels to be made, world units: the integral of the values stays
    isosurface  makes a level set of the surface where the volume has this value; half_width of its band, voxels [3]
    override    spacing and origin also take the place of what a file states
    strict      refuse plain files that are longer than their header says

    What was lost is in `Volume.losses`, and a warning (UmbrickWarning) tells what should be known of it.
    Raises InvalidArgument, IoError, OutOfMemory.
    """
    options = given(spacing=spacing, origin=origin, name=name, unit=unit, length_unit=length_unit, space=space,
                    background=background, tolerance=tolerance, threshold=threshold, clip_below=clip_below, range=range,
                    half=half, step=step, max_error=max_error, crop=crop, resample=resample, isosurface=isosurface,
                    half_width=half_width, component=component)
    if mask is not None:
        options["mask"] = os.fspath(mask)
    files = given(frame=frame, grid=grid, series=series, where=where, override=override, strict=strict,
                  beside_only=beside_only, dims=dims, type=type, endian=endian, header_bytes=header_bytes,
                  bits_stored=bits_stored)
    if hasattr(source, "dataobj") or is_array(source):
        _refuse("convert", "files", **files)
        array, place = _array_of(source)
        handle = _core.convert_array(array, {**place, **options, **given(affine=affine, axes=axes)}, progress)
    else:
        _refuse("convert", "arrays", affine=affine, axes=axes)
        handle = _core.convert_file(_path_of(source), {**options, **files}, progress)
    warn(handle.notes, handle.source)
    return Volume(handle)


def _path_of(source):
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"source: expected an array, a path or an image of nibabel, found {type(source).__name__}")
    return os.fspath(source)


def volume_of(source: Any) -> Volume:
    """Returns the volume of whatever functions take for one."""
    return source if isinstance(source, Volume) else Volume.open(source)


def _pyopenvdb():
    try:
        import pyopenvdb
    except ImportError as error:
        raise ImportError("pyopenvdb is not installed (Debian: python3-openvdb)") from error
    return pyopenvdb


def _refuse(function, what, **keywords):
    for name, value in keywords.items():
        if value is not None:
            raise _core.InvalidArgument(f"{name}: expected no such keyword of {function}, since it is for {what}, "
                                        f"found {value!r:.60}")
