# What the functions of the package have in common: keywords, warnings and volumes in any form.
# SPDX-License-Identifier: Apache-2.0
"""What the functions of the package have in common."""
import difflib
import json
import logging
import os
import warnings

from . import _core

_LOG = logging.getLogger("umbrick")
_MEANINGFUL_NONE = {"background", "clip_box"}


class UmbrickWarning(UserWarning):
    """Something was lost, clipped or rounded, or a picture shows nothing. The message says what."""


def warn(notes, source="", level=3):
    """Warns of each note, at the line that called the public function."""
    for note in notes:
        warnings.warn(f"{source}: {note}" if source else note, UmbrickWarning, stacklevel=level)


def tell(source, notes):
    """Logs what was chosen, for who wants to know."""
    for note in notes:
        _LOG.info("%s: %s", source, note)


def given(**keywords):
    """Returns the keywords that are not None."""
    return {name: value for name, value in keywords.items() if value is not None}


def scene_keywords(function, keywords):
    """Returns the keywords of a scene, of which None is not given. Raises TypeError for one that there is not."""
    known = _core.scene_keywords()
    for name in keywords:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise TypeError(f"{function}() got an unexpected keyword argument '{name}'{hint}")
    return {name: value for name, value in keywords.items() if value is not None or name in _MEANINGFUL_NONE}


def scene_given(scene):
    """Returns a scene as the core takes it: None, the text of a dictionary, or the path of a file."""
    if scene is None:
        return None
    if isinstance(scene, (str, os.PathLike)):
        return _Path(os.fspath(scene))
    if not isinstance(scene, dict):
        raise TypeError(f"scene: expected a dictionary or the path of a .json file, found {type(scene).__name__}")
    from . import _json

    try:
        return _json.dumps(scene)
    except (TypeError, ValueError) as error:
        raise _core.InvalidArgument(f"scene: expected what JSON can hold: {error}") from None


class _Path:
    """A path that the core does not take for the text of a scene."""

    def __init__(self, path):
        self._path = path

    def __fspath__(self):
        return self._path


def is_array(source):
    """Tells whether something is an array, or becomes one."""
    return hasattr(source, "__array__") or hasattr(source, "__array_interface__")


def parse(text):
    """Returns the dictionary of a JSON text; None where there is none."""
    return json.loads(text) if text else None
