# SPDX-License-Identifier: Apache-2.0
"""Files made of a file: a shorter one, and splats for other programs."""
from __future__ import annotations

from typing import Optional

from . import _slf
from ._arguments import MOST_METRES, number, whole, wrong
from ._notes import Notes, notes_text
from ._parts import part_of, with_part
from ._sources import bytes_of, named
from ._types import Box, Source

FORMATS = ('ply', 'glb', 'spz', 'spz3', 'spz4', 'sog')
AXES = ('auto', 'world', 'y-up', 'y-down')


def truncate(source: Source, *, levels: int = 0, groups: int = 0, layers: int = 0,
             max_bytes: int = 0, region: Optional[Box] = None, threads: int = 0,
             max_memory: int = 0) -> bytes:
    """A file with less in it, without coding again: what read() gives of the file with these
    arguments, it gives of the result.

    max_bytes: the file has so many bytes at most. Others as of read(). Of a region all of the slices
    that meet it stay. Raises DamagedError, UnsupportedError, LimitError, ArgumentError; OSError.
    """
    part = part_of(levels, groups, layers, max_bytes, threads, max_memory)
    with named(source):
        return with_part(bytes_of(source), part, region,
                         lambda data, whole_part: _slf.truncate(data, **whole_part))


def annotate(source: Source, *, notes: Optional[Notes] = None, remove_notes: bool = False,
             metres_per_unit: Optional[float] = None) -> bytes:
    """A file with other notes or another scale, nothing coded again: read() gives the same points and values.

    notes: what docs/notes.md describes, a file of it or as of json.load(), in place of those of the file.
    metres_per_unit: 0 where it is not known. What is not given stays. Raises InputError for notes that break a rule,
    DamagedError, UnsupportedError, LimitError, ArgumentError; OSError.
    """
    if notes is not None and remove_notes:
        raise wrong('notes', 'notes are given, and to be removed')
    metadata: list[tuple[str, Optional[str]]] = []
    if notes is not None:
        metadata = [('notes', notes_text(notes))]
    elif remove_notes:
        metadata = [('notes', None)]
    metres = None if metres_per_unit is None else float(number(metres_per_unit, 'metres_per_unit', 0, MOST_METRES))
    with named(source):
        return _slf.annotate(bytes_of(source), metadata, metres)


def export(source: Source, format: str = 'ply', *, degree: int = 3, size: float = 0.55,
           axes: str = 'auto', levels: int = 0, groups: int = 0, layers: int = 0,
           max_bytes: int = 0, region: Optional[Box] = None, threads: int = 0,
           max_memory: int = 0) -> bytes:
    """A file of Gaussian splats for other programs, as `slf export` makes it (docs/export.md).

    format: 'ply' (3-D Gaussian splatting), 'glb' (KHR_gaussian_splatting), 'spz', 'spz3', 'spz4'
    (versions 2, 3 and 4), 'sog' (PlayCanvas). degree: of the harmonics, 0 to 3. size: standard deviation of
    a splat, in distances between neighbouring points, 0.1 to 4. axes: 'auto' is that of the format;
    'world', 'y-up', 'y-down'. size and axes are not of files that hold splats, which stay what they are.
    Others as of read(). Raises what read() raises; InputError where colours have no meaning.
    """
    if format not in FORMATS:
        raise wrong('format', f'format is {", ".join(FORMATS)}, not {format!r:.40}')
    if axes not in AXES:
        raise wrong('axes', f'axes is {", ".join(AXES)}, not {axes!r:.40}')
    deviation = float(number(size, 'size', 0.1, 4))
    part = part_of(levels, groups, layers, max_bytes, threads, max_memory)
    order = whole(degree, 'degree', 0, 3)
    with named(source):
        return with_part(bytes_of(source), part, region, lambda data, whole_part: _slf.export(
            data, **whole_part, format=format, degree=order, size=deviation, axes=axes))
