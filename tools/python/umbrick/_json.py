# JSON of dictionaries that hold arrays and numbers of NumPy.
# SPDX-License-Identifier: Apache-2.0
"""JSON of dictionaries that hold arrays and numbers of NumPy."""
import json
import os


def _plain(value):
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{type(value).__name__} has no JSON")


def dumps(value) -> str:
    """Returns the text of a value. Raises ValueError for NaN and infinity, which JSON does not have."""
    return json.dumps(value, default=_plain, allow_nan=False)
