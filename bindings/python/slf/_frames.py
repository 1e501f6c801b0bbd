# SPDX-License-Identifier: Apache-2.0
"""Frames of a light field that moves."""
from __future__ import annotations

import functools
import operator
from typing import Any, Callable, Dict, Iterator, Optional, Sequence, Tuple, Union, overload

from . import _slf
from ._arguments import MOST_BYTES, whole
from ._errors import ArgumentError
from ._field import LightField
from ._parts import info_of, of_part, voxels_of
from ._sources import Data, bytes_of, named, picklable
from ._types import Box, Frame, Info, Source


class Frames(Sequence[LightField]):
    """Light fields of a stream, one after the other: len(), [i], and a for loop.

    A frame is decoded when it is asked for. One that is predicted needs those before it, back to one
    that is not: in order each is decoded once. A light field that does not move is one frame.
    """

    def __init__(self, data: Data, part: Dict[str, Any]) -> None:
        self._data = data
        self._part = part
        self._frames = _slf.Frames(data, **part)

    def __len__(self) -> int:
        return self._frames.count()

    def __repr__(self) -> str:
        return f'<slf.Frames: {len(self)}>'

    @functools.cached_property
    def list(self) -> Tuple[Frame, ...]:
        """Number, time and place in the stream of every frame; nothing is decoded."""
        return tuple(Frame(**self._frames.info(place)) for place in range(len(self)))

    @overload
    def __getitem__(self, place: int) -> LightField: ...

    @overload
    def __getitem__(self, place: slice) -> Sequence[LightField]: ...

    def __getitem__(self, place: Union[int, slice]) -> Union[LightField, Sequence[LightField]]:
        if isinstance(place, slice):
            return [self[i] for i in range(*place.indices(len(self)))]
        if not -len(self) <= operator.index(place) < len(self):
            raise IndexError(f'frame {place} is asked for, but there are {len(self)}, from 0 on')
        at = range(len(self))[place]
        try:
            field = self._frames.decode(at)
        except ArgumentError as error:
            raise of_part(error, lambda: self._header(at)) from None
        return LightField(field, lambda: self._pictures.renderer(at),
                          lambda: (_frame, (picklable(self._data), self._part, at)), self.list[at])

    def _header(self, at: int) -> Info:
        """Headers of the frame that a group begins with are those of the group."""
        while self.list[at].predicted and at > 0:
            at -= 1
        first = self.list[at]
        return info_of(memoryview(self._data).cast('B')[first.offset:first.offset + first.bytes])

    def __reduce__(self) -> Tuple[Callable[..., Frames], Tuple[Any, ...]]:
        """Pickled as the bytes of its stream."""
        return Frames, (picklable(self._data), self._part)

    def __iter__(self) -> Iterator[LightField]:
        return (self[place] for place in range(len(self)))

    @functools.cached_property
    def _pictures(self) -> _slf.FramePictures:
        return _slf.FramePictures(self._data, **self._part)


def _frame(data: Data, part: Dict[str, Any], place: int) -> LightField:
    return Frames(data, part)[place]


def frames(source: Source, *, levels: int = 0, groups: int = 0, region: Optional[Box] = None,
           threads: int = 0, max_memory: int = 0) -> Frames:
    """The frames of a file, of bytes (not to be changed after) or of an open file.

        for field in slf.frames('walk.slf'):
            show(field.frame.time, field.points, field.mean_colours)

    Arguments are those of read(), of every frame. A frame that is damaged raises DamagedError when it
    is decoded, and so do those of its group after it; later groups do not.
    Raises DamagedError where no frame begins, ArgumentError; OSError of a file.
    """
    part: Dict[str, Any] = {
        'levels': whole(levels, 'levels', 0, 21), 'groups': whole(groups, 'groups', 0, 16),
        'threads': whole(threads, 'threads'),
        'max_memory': whole(max_memory, 'max_memory', 0, MOST_BYTES)}
    with named(source):
        data = bytes_of(source)
        part['region'] = None if region is None else voxels_of(data, region)
        return Frames(data, part)
