# SPDX-License-Identifier: Apache-2.0
"""Notes: points with text, and guided tours (docs/notes.md)."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Mapping, Union

import numpy as np

from . import _slf

Notes = Union[str, 'os.PathLike[str]', Mapping[str, Any]]


def notes_text(notes: Notes) -> str:
    """The JSON of a file or of a dict, checked. Raises InputError with file and element; OSError of a file."""
    if isinstance(notes, (str, os.PathLike)):
        return _slf.checked_notes(os.fspath(notes), pathlib.Path(notes).read_bytes())
    return _slf.checked_notes('notes', json.dumps(dict(notes), default=_plain).encode())


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as those of Python."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f'notes: {type(value).__name__} is not of JSON')
