# The package umbrick: sparse volumes, converted, rendered and measured.
# SPDX-License-Identifier: Apache-2.0
"""Umbrick: sparse volumes, converted, rendered and measured.

    import umbrick

    volume = umbrick.Volume.open("scan.nii.gz")          # or convert(array, spacing=(1, 1, 2))
    picture = umbrick.render(volume, model="cone", theta=60, size=(512, 512))
    picture.save("scan.png")

convert, Volume              files and arrays as sparse volumes, and back
render, Renderer, Picture    pictures
reference, compare           what a picture should be, and how far off it is
check, study                 whether bricks change anything; what accuracy costs
tf_auto, tf_list, tf_load    transfer functions

Errors are exceptions below `Error`, whose message is one line; what was lost is a warning, UmbrickWarning; what was
chosen is logged by the logger "umbrick" and kept in notes. All that takes long has `progress=`, ends by Ctrl+C and
leaves the interpreter free for other threads.

An array is indexed [x, y, z], as in pyopenvdb and nibabel; axes="zyx" takes one that is indexed [z, y, x].
"""
from ._core import Error, GlError, InvalidArgument, IoError, OutOfMemory, __version__, scene_keywords
from ._common import UmbrickWarning
from ._volume import Volume, convert
from ._picture import Picture, compare
from ._drawing import Renderer, reference, render
from ._measure import check, study, tf_auto, tf_list, tf_load

__all__ = [
    "Error",
    "GlError",
    "InvalidArgument",
    "IoError",
    "OutOfMemory",
    "Picture",
    "Renderer",
    "UmbrickWarning",
    "Volume",
    "__version__",
    "check",
    "compare",
    "convert",
    "reference",
    "render",
    "scene_keywords",
    "study",
    "tf_auto",
    "tf_list",
    "tf_load",
]
