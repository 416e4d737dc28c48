# Pictures of volumes: render, Renderer, reference.
# SPDX-License-Identifier: Apache-2.0
"""Pictures of volumes: render, Renderer, reference."""
import os
from typing import Any, Callable, Dict, Optional, Sequence, Union

from . import _core
from ._common import given, parse, scene_given, scene_keywords
from ._picture import Picture, told
from ._volume import Volume, volume_of

Progress = Callable[[float, str], Any]
Scene = Union[Dict[str, Any], str, "os.PathLike[str]"]


def _opened(volume, scene, progress):
    """Returns the core's volume and scene. A path of a scene stands for both."""
    if isinstance(volume, (str, os.PathLike)) and os.fspath(volume).endswith(".json") and scene is None:
        volume, scene = None, volume
    if isinstance(volume, (str, os.PathLike)) and os.fspath(volume).endswith((".vdb", ".nvdb")) and scene is None:
        return os.fspath(volume), None  # among whose grids one that emits is looked for
    handle = None
    if volume is not None:
        handle = (volume if isinstance(volume, Volume) else volume_of(volume))._handle
    return handle, scene_given(scene)


def render(
    volume: Any = None,
    scene: Optional[Scene] = None,
    *,
    layers: bool = False,
    backend: Optional[str] = None,
    light_sweep: Optional[str] = None,
    progressive: Optional[int] = None,
    max_seconds: Optional[float] = None,
    target_error: Optional[float] = None,
    seed: Optional[int] = None,
    progress: Optional[Progress] = None,
    **keywords: Any,
) -> Picture:
    """Makes a picture of a volume: the one that `umbrick render` makes of the same words, to the last bit.

    volume    a Volume, a path, an array, or None where the scene names a file. Without `tf` a path of a .vdb also shows
              the grid of it that emits light, as `umbrick render` does; of a Volume, Volume.open(emission_grid="auto")
    scene     a dictionary as scene files have it (Picture.scene is one), or the path of such a file. Without it, what no
              keyword says is chosen so that the picture shows something: Picture.chosen
    keywords  the options of `umbrick render` with _ for -: size=(512, 512), tf="ct-head", model="cone", theta=60,
              azimuth=30, view="front", eye=(x, y, z), clip_box=((...), (...)), clip_planes=[(a, b, c, d)], mode="mip",
              iso=[300, 1200], quality="high", samples=4, background="white", ...; umbrick.scene_keywords() lists them.
              tf may also be a dictionary as transfer functions have it: tf_auto() makes one. Angles are in degrees
    layers    also make the layers V and Z
    backend   "auto", "cpu", "osmesa" or "egl"; light_sweep "auto", "cpu" or "gl"

    progressive, max_seconds, target_error, seed: the mean of so many samples, as many as fit into so many seconds, or
    as many as the estimated RMSE needs; Picture.error tells it.

    progress is called with the share that is done, in [0, 1], and the step; what it raises ends the work, as Ctrl+C
    does. The interpreter is not locked meanwhile.

    Raises TypeError for a keyword that there is not, InvalidArgument, IoError, GlError, OutOfMemory.
    """
    words = scene_keywords("render", keywords)
    options = given(layers=layers, backend=backend, light_sweep=light_sweep, progressive=progressive,
                    max_seconds=max_seconds, target_error=target_error, seed=seed)
    handle, text = _opened(volume, scene, progress)
    return told(_core.render(handle, text, words, options, progress))


class Renderer:
    """A renderer that lives as long as its volume is looked at: changes upload no more than they ask for.

        renderer = umbrick.Renderer(volume, tf="ct-head", size=(512, 512))
        for azimuth in range(0, 360, 10):
            renderer.set(azimuth=azimuth).render().save(f"turn-{azimuth:03}.png")

    Arguments are as for `render`. Any thread may use it; calls take turns.
    """

    def __init__(
        self,
        volume: Any,
        scene: Optional[Scene] = None,
        *,
        layers: bool = False,
        backend: Optional[str] = None,
        light_sweep: Optional[str] = None,
        progressive: Optional[int] = None,
        max_seconds: Optional[float] = None,
        target_error: Optional[float] = None,
        seed: Optional[int] = None,
        progress: Optional[Progress] = None,
        **keywords: Any,
    ):
        words = scene_keywords("Renderer", keywords)
        options = given(layers=layers, backend=backend, light_sweep=light_sweep, progressive=progressive,
                        max_seconds=max_seconds, target_error=target_error, seed=seed)
        self._renderer = _core.Renderer(volume_of(volume)._handle, scene_given(scene), words, options, progress)

    def set(self, *, progress: Optional[Progress] = None, **keywords: Any) -> "Renderer":
        """Changes the scene by keywords of `render`; what is not named stays. An orbit stays around what was seen first.
        Where this raises, the scene stays as it was. background=None and clip_box=None take these away."""
        self._renderer.set(scene_keywords("Renderer.set", keywords), progress)
        return self

    def set_transfer(self, tf: Any) -> "Renderer":
        """Takes another transfer function: a preset, a file, "auto" or a dictionary. Uploads the bricks that become
        visible and are not resident."""
        return self.set(tf=tf)

    def set_camera(self, **keywords: Any) -> "Renderer":
        """Moves the camera: azimuth, elevation, zoom, pan, view, up, fov, or eye and look_at. Uploads nothing."""
        return self.set(**keywords)

    def set_clip(self, planes: Sequence[Sequence[float]] = (), box: Any = None) -> "Renderer":
        """Replaces the clip planes (a, b, c, d: keep a x + b y + c z + d >= 0) and the clip box, world units. Uploads
        nothing."""
        return self.set(clip_planes=list(planes), clip_box=box)

    def set_theta(self, theta: float) -> "Renderer":
        """Sets the half-angle of the cone, degrees. Uploads nothing."""
        return self.set(theta=theta)

    def render(self, *, progress: Optional[Progress] = None) -> Picture:
        """Draws the scene. Raises as `umbrick.render`."""
        return told(self._renderer.render(progress), again=True)

    @property
    def scene(self) -> Dict[str, Any]:
        """The present scene, as `scene` of `render` takes it."""
        return parse(self._renderer.scene_text)


def reference(
    volume: Any = None,
    scene: Optional[Scene] = None,
    *,
    integrator: Optional[str] = None,
    reference_directions: Optional[int] = None,
    tolerance: Optional[float] = None,
    step: Optional[float] = None,
    paths: Optional[int] = None,
    standard_error: Optional[float] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    layers: bool = False,
    progress: Optional[Progress] = None,
    **keywords: Any,
) -> Picture:
    """Integrates the same scene on the CPU in double precision, as `umbrick reference` does: what a picture should be.

    volume, scene, keywords, layers, progress  as for `render`
    integrator            "quadrature" (deterministic) or "monte-carlo", which adds the layer standardError
    reference_directions  of quadrature: about so many over the cone, the sphere or the lights [256]
    tolerance             of quadrature: of the radiance of a stretch of the ray, in (0, 1] [1e-4]
    step                  of quadrature: distance of the points where occlusion is computed, voxels [as tolerance asks]
    paths                 of monte-carlo: a pixel, at most [256; with standard_error as many as it takes]
    standard_error        of monte-carlo: a pixel is done at this estimate
    seed, threads         of monte-carlo; 0 threads: one for each core

    Raises as `render`.
    """
    words = scene_keywords("reference", keywords)
    options = given(integrator=integrator, reference_directions=reference_directions, tolerance=tolerance, step=step,
                    paths=paths, standard_error=standard_error, seed=seed, threads=threads, layers=layers)
    handle, text = _opened(volume, scene, progress)
    return told(_core.reference(handle, text, words, options, progress))
