# Pictures: pixels, layers and files.
# SPDX-License-Identifier: Apache-2.0
"""Pictures: pixels, layers and files."""
import os
import tempfile
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

from . import _core
from ._common import parse, tell, warn


class Picture:
    """A picture, made by `umbrick.render`, `Renderer.render`, `umbrick.reference` or `Picture.open`.

    NumPy takes it for its colour: np.asarray(picture). In a notebook it shows itself.
    """

    __slots__ = ("_handle",)

    def __init__(self, handle: "_core.Picture"):
        self._handle = handle

    @classmethod
    def open(cls, path: Union[str, "os.PathLike[str]"]) -> "Picture":
        """Reads an .exr with its layers, or a .png, which becomes linear. Raises IoError, InvalidArgument."""
        return cls(_core.open_picture(os.fspath(path)))

    @property
    def colour(self) -> np.ndarray:
        """height x width x 4 float32: linear RGB, premultiplied by alpha, row 0 at the top. It shares the memory of the
        picture (so that it is read-only, and its rows lie in memory from the bottom up)."""
        return self._handle.colour

    @property
    def layers(self) -> Dict[str, np.ndarray]:
        """height x width (x channels) float32 by name, in the same way: V (visibility weighted by opacity) and Z (mean
        depth along the view axis, world units) where `layers` asked for them; value, position and normal of other
        modes; standardError of a Monte Carlo reference."""
        return self._handle.layers

    @property
    def width(self) -> int:
        """Pixels."""
        return self.colour.shape[1]

    @property
    def height(self) -> int:
        """Pixels."""
        return self.colour.shape[0]

    @property
    def scene(self) -> Optional[Dict[str, Any]]:
        """All that the picture depends on, as `scene` of `render` takes it: the same picture, to the last bit. None of a
        file that does not hold it."""
        return parse(self._handle.scene_text)

    @property
    def chosen(self) -> Dict[str, str]:
        """Keywords that nobody gave, with the values that were chosen."""
        return dict(self._handle.chosen)

    @property
    def reasons(self) -> List[str]:
        """Why they were chosen, and what was guessed while the volume was opened."""
        return self._handle.reasons

    @property
    def notes(self) -> List[str]:
        """What was lost or rounded, and why nothing is seen: what `render` has warned of."""
        return self._handle.notes

    @property
    def stats(self) -> Dict[str, Any]:
        """How it was drawn: engine, technique, ms, bricks, visible_bricks, uploaded_bricks, bytes, ..."""
        return self._handle.stats

    @property
    def error(self) -> Optional[Dict[str, Any]]:
        """Of a progressive picture the estimated RMSE of linear premultiplied RGB: statistical, systematic, total, and
        whether the target is reached (reached_target). None of others."""
        return self._handle.error

    def save(
        self,
        path: Union[str, "os.PathLike[str]"],
        *,
        exposure: Optional[float] = None,
        tone: Optional[str] = None,
        background: Optional[str] = None,
        annotate: Union[None, str, Sequence[str]] = None,
        exr_pixel: Optional[str] = None,
    ) -> None:
        """Writes a .png (8-bit sRGB) or an .exr (linear, with all layers), whole or not at all, with its scene.

        exposure    of a .png, stops: radiance times 2^exposure [0]
        tone        of a .png: "none", "reinhard" or "filmic" ["none"]
        background  of a .png: "gradient", behind what is transparent
        annotate    of a .png: "triad", "scale", "colours", several of them, or "all"
        exr_pixel   of an .exr: "half" or "float" ["half"]

        Raises IoError, InvalidArgument.
        """
        options = {name: value for name, value in (("exposure", exposure), ("tone", tone), ("background", background),
                                                   ("annotate", annotate), ("exr_pixel", exr_pixel))
                   if value is not None}
        for left_out in self._handle.save(os.fspath(path), options):
            warn([f"the picture has no room for the annotation {left_out}"], os.fspath(path))

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        colour = self.colour
        return colour if dtype is None or dtype == colour.dtype else colour.astype(dtype)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory(prefix="umbrick-") as folder:
            path = os.path.join(folder, "picture.png")
            self._handle.save(path, {})
            with open(path, "rb") as file:
                return file.read()

    def __repr__(self) -> str:
        layers = "".join(f", {name}" for name in self.layers)
        return f"<umbrick.Picture {self.width} x {self.height}, RGBA{layers}>"


def told(handle: "_core.Picture", again: bool = False) -> Picture:
    """Returns a picture after what should be known of it is said: choices not again for each picture of a renderer."""
    warn(handle.notes, level=4)
    if (handle.chosen or handle.reasons) and not again:
        words = [f"{name}={value}" for name, value in handle.chosen] + list(handle.reasons)
        tell("render", ["; ".join(words)])
    return Picture(handle)


def compare(
    test: Any,
    reference: Any,
    *,
    layer: Optional[str] = None,
    background: Sequence[float] = (0, 0, 0),
    pixels_per_degree: Optional[float] = None,
) -> Dict[str, Any]:
    """Measures how far a picture is from its reference, as `umbrick compare` does.

    test, reference    pictures, paths of .exr or .png files, or arrays of height x width (x channels), linear
                       premultiplied, row 0 at the top
    layer              of pictures and files: compare this layer by its name [the colour]
    background         behind transparent pictures, linear RGB in [0, 1]; SSIM and FLIP only
    pixels_per_degree  of visual angle, for FLIP [0.7 m from a display 0.7 m and 3840 pixels wide]

    Returns rmse, rmse_rgb, max_error, p999, rel_mse, ssim, flip (None where a layer does not have them),
    max_error_pixel (x, y from the top left), non_finite_differing, non_finite_equal.
    Raises InvalidArgument where sizes or channels differ, IoError.
    """
    options = (3840 * 3.14159265358979323846 / 180) if pixels_per_degree is None else pixels_per_degree
    return _core.compare(_pixels(test, layer), _pixels(reference, layer), tuple(background), options)


def _pixels(picture, layer):
    if isinstance(picture, (str, os.PathLike)):
        picture = Picture.open(picture)
    if not isinstance(picture, Picture):
        if layer is not None:
            raise _core.InvalidArgument(f"layer: expected pictures or files beside it, found {type(picture).__name__}")
        return picture
    if layer is None:
        return picture.colour
    layers = picture.layers
    if layer not in layers:
        raise _core.InvalidArgument(f"layer: expected one of {', '.join(layers) or 'none'}, found {layer!r}")
    return layers[layer]
