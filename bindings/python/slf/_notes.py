# SPDX-License-Identifier: Apache-2.0
"""Notes: points with text, and guided tours (docs/notes.md)."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Mapping, Union

from . import _slf

Notes = Union[str, 'os.PathLike[str]', Mapping[str, Any]]


def notes_text(notes: Notes) -> str:
    """The JSON of a file or of a dict, checked. Raises InputError with file and element; OSError of a file."""
    if isinstance(notes, (str, os.PathLike)):
        return _slf.checked_notes(os.fspath(notes), pathlib.Path(notes).read_bytes())
    return _slf.checked_notes('notes', json.dumps(dict(notes)).encode())
