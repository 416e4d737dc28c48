# What is measured: check, study; and transfer functions.
# SPDX-License-Identifier: Apache-2.0
"""What is measured: check, study; and transfer functions."""
import json
import os
from typing import Any, Callable, Dict, Mapping, Optional, Sequence, Tuple, Union

from . import _core
from ._common import given, parse, scene_given, scene_keywords, tell
from ._volume import volume_of

Progress = Callable[[float, str], Any]
Scene = Union[Dict[str, Any], str, "os.PathLike[str]"]


def check(
    volume: Any,
    scene: Optional[Scene] = None,
    *,
    edges: Optional[Sequence[int]] = None,
    slices: Optional[int] = None,
    seed: Optional[int] = None,
    backend: Optional[str] = None,
    progress: Optional[Progress] = None,
    **keywords: Any,
) -> Dict[str, Any]:
    """Measures on a volume that bricks and culling change nothing and that techniques agree, as `umbrick check` does.

    volume, scene, keywords  as for `render`, but for model and technique
    edges                    of bricks that are compared, voxels, multiples of 8 [8, 16, 32, 64]
    slices                   of each view whose pixels are looked at one by one [24]
    seed                     of the choice of bricks whose voxels are read [1]
    backend                  "auto", "osmesa" or "egl"

    Returns passed, engine, seed, scene, and invariants: for each its number, name, what was measured, value, limit,
    limit_from, samples, excluded, passed and detail.
    Raises as `render`.
    """
    words = scene_keywords("check", keywords)
    options = given(edges=edges, slices=slices, seed=seed, backend=backend)
    done = _core.check(volume_of(volume)._handle, scene_given(scene), words, options, progress)
    done["scene"] = parse(done.pop("scene_text"))
    return done


def study(
    volume: Any,
    folder: Union[str, "os.PathLike[str]"],
    scene: Optional[Scene] = None,
    *,
    quick: Optional[bool] = None,
    techniques: Optional[bool] = None,
    methods: Optional[Sequence[str]] = None,
    slices: Optional[Sequence[int]] = None,
    details: Optional[Mapping[str, Sequence[int]]] = None,
    bits: Optional[Sequence[Tuple[int, int]]] = None,
    segments: Optional[Sequence[int]] = None,
    sizes: Optional[Sequence[int]] = None,
    thetas: Optional[Sequence[float]] = None,
    scales: Optional[Sequence[float]] = None,
    repeats: Optional[int] = None,
    reference_directions: Optional[int] = None,
    reference_tolerance: Optional[float] = None,
    backend: Optional[str] = None,
    progress: Optional[Progress] = None,
    **keywords: Any,
) -> Dict[str, Any]:
    """Measures speed against error, as `umbrick study` does, and returns its record: what study.json holds.

    volume            a path, or a Volume that was opened from one, by which the record knows it
    folder            new, empty, or of the same study, which goes on: it gets study.csv, study.json and the references.
                      `umbrick study` with the same options then makes the page of it without measuring again
    quick             a small study; techniques: all techniques beside each other
    methods           names, such as "emission", "dos", "ordinates", "light-volume"
    slices, segments, sizes (pixels), thetas (degrees), scales (texels per voxel edge)    what is swept
    details           by name: {"footprint": [2, 3], "directions": [8, 16]}
    bits              pairs: of the eye and of the occlusion buffer
    repeats           timed turns of baseline and case, at least
    reference_directions, reference_tolerance    of the references
    scene, keywords, backend, progress           as for `check`

    Ctrl+C ends it between two cases; the same call goes on. Raises as `render`.
    """
    words = scene_keywords("study", keywords)
    options = given(quick=quick, techniques=techniques, methods=methods, slices=slices, details=details, bits=bits,
                    segments=segments, sizes=sizes, thetas=thetas, scales=scales, repeats=repeats,
                    reference_directions=reference_directions, reference_tolerance=reference_tolerance,
                    backend=backend)
    return json.loads(
        _core.study(volume_of(volume)._handle, os.fspath(folder), scene_given(scene), words, options, progress))


def tf_auto(volume: Any) -> Dict[str, Any]:
    """Returns the transfer function that fits a volume, as a dictionary that `tf` takes: points of value (grid units),
    albedo (linear RGB) and sigma_t (1/world unit). Why is logged by the logger "umbrick"."""
    volume = volume_of(volume)
    text, reason = _core.tf_auto(volume._handle)
    tell(volume.source, [reason])
    return json.loads(text)


def tf_list() -> Dict[str, str]:
    """Returns the presets by name, with what they are for."""
    return _core.tf_list()


def tf_load(name_or_file: Union[str, "os.PathLike[str]"]) -> Dict[str, Any]:
    """Returns a preset or a file (also a colour map of ParaView) as a dictionary. Raises IoError."""
    return json.loads(_core.tf_load(os.fspath(name_or_file)))
