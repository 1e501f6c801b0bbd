# SPDX-License-Identifier: Apache-2.0
"""Decoding: what of a stream, its arrays, its pictures."""
from __future__ import annotations

import contextlib
import functools
import os
from typing import Any, Callable, Dict, Iterator, Optional, Tuple, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _slf
from ._arguments import MOST_BYTES, MOST_PIXELS, colour, fixed, pixels, whole, wrong
from ._errors import ArgumentError, DamagedError, Error, LimitError, UnsupportedError, of_source
from ._notebook import Turntable, png
from ._ranges import FileRanges, Ranges, UrlRanges, is_address, ranges_of, whole_of
from ._types import Box, Camera, Frame, Info, Source, Vector
from ._view_map import directions_of, display_values, plotted


Data = Union[bytes, bytearray, memoryview]


def _bytes(source: Source) -> Data:
    if isinstance(source, (bytes, bytearray, memoryview)):
        return source
    if is_address(source):
        return whole_of(UrlRanges(str(source)))
    if isinstance(source, (str, os.PathLike)):
        with open(source, 'rb') as file:
            return file.read()
    read_all = getattr(source, 'read', None)
    data = read_all() if callable(read_all) else None
    if not isinstance(data, (bytes, bytearray, memoryview)):
        raise TypeError(f'a path, an address, bytes or a binary file are needed, not {type(source).__name__}')
    return data


def _in_parts(source: Source) -> Union[Data, Ranges]:
    """What no more is read of than is needed, where that can be."""
    ranges = ranges_of(source)
    if ranges is None:
        return _bytes(source)
    return ranges if not isinstance(ranges, UrlRanges) or ranges.ranges else whole_of(ranges)


@contextlib.contextmanager
def _named(source: Source) -> Iterator[None]:
    """Errors of a stream name the path or the address that it is from."""
    try:
        yield
    except (DamagedError, UnsupportedError, LimitError) as error:
        if not isinstance(source, (str, os.PathLike)):
            raise
        raise of_source(error, os.fspath(source)) from None


def _info(fields: Dict[str, Any]) -> Info:
    return Info(**fields)


def info(source: Source) -> Info:
    """Headers of a file, an address or bytes; nothing is decoded.

    If a file has an index, as `slf encode` writes it, only its beginning is read: damage behind it
    is not seen. Raises DamagedError, UnsupportedError; OSError of a file.
    """
    with _named(source):
        return _info(_slf.info(_in_parts(source)))


class LightField:
    """A decoded light field. Arrays are read when first asked for, and are not to be written to."""

    def __init__(self, field: _slf.Field, make_renderer: Callable[[], _slf.Renderer],
                 made_by: Callable[[], Tuple[Callable[..., LightField], Tuple[Any, ...]]],
                 frame: Optional[Frame] = None) -> None:
        self._field = field
        self._make_renderer = make_renderer
        self._made_by = made_by
        self._shape = field.shape()
        self.frame = frame  #: which of a light field that moves, of frames(); None of read()

    def __len__(self) -> int:
        return int(self._shape['points'])

    def __reduce__(self) -> Tuple[Callable[..., LightField], Tuple[Any, ...]]:
        """Pickled as the bytes of its stream, and decoded again."""
        return self._made_by()

    def __repr__(self) -> str:
        return f'<slf.LightField of {len(self)} points, {self.header.functions} functions>'

    @functools.cached_property
    def header(self) -> Info:
        """The grid of the whole stream; bits, step and origin are those of its own grid."""
        return _info(self._field.info())

    @property
    def partial(self) -> bool:
        """Less was decoded than the stream was made of."""
        return bool(self._shape['partial'])

    @property
    def step(self) -> float:
        """World units between voxels of these points; larger with fewer levels."""
        return float(self._shape['step'])

    @property
    def origin(self) -> Vector:
        """World position of voxel (0, 0, 0) of these points."""
        x, y, z = self._shape['origin']
        return (x, y, z)

    @functools.cached_property
    def positions(self) -> npt.NDArray[np.int32]:
        """Voxels, int32 [P, 3], Morton order."""
        return fixed(self._field.positions())

    @functools.cached_property
    def points(self) -> npt.NDArray[np.float64]:
        """World positions, float64 [P, 3]."""
        return fixed(np.asarray(self.origin, np.float64) + np.float64(self.step) * self.positions)

    @functools.cached_property
    def components(self) -> npt.NDArray[np.int32]:
        """The integers of the bit exact decode, int32 [P, R, 3]."""
        return fixed(self._field.components())

    @functools.cached_property
    def normals(self) -> npt.NDArray[np.float32]:
        """Unit normals, float32 [P, 3], of either sign: coded, else estimated; 0 where unknown."""
        return fixed(self._field.normals())

    @functools.cached_property
    def radii(self) -> npt.NDArray[np.float32]:
        """Radii of the discs that a renderer draws, float32 [P], world units."""
        return fixed(self._field.radii())

    @functools.cached_property
    def mean_colours(self) -> npt.NDArray[np.uint8]:
        """R, G, B averaged over all directions, uint8 [P, 3]."""
        return fixed(self._field.mean_colours())

    def radiance(self, points: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Colours of points along directions, float32 of the broadcast shape [..., 3].

        points: indices [...], 0 to P - 1; directions [..., 3]: world, from the point to the eye, any
        length above 0. Values of header.transfer. Raises ValueError, IndexError.
        """
        where = np.asarray(points)
        along = np.asarray(directions, np.float32)
        if where.dtype.kind not in 'iu' or along.ndim < 1 or along.shape[-1] != 3:
            raise ValueError('points are whole numbers and directions [..., 3]')
        if where.size and not (0 <= int(where.min()) and int(where.max()) < len(self)):
            raise IndexError(f'points are 0 to {len(self) - 1}')
        shape = np.broadcast_shapes(where.shape, along.shape[:-1])
        flat = np.broadcast_to(where, shape).reshape(-1).astype(np.uint32)
        rays = np.ascontiguousarray(np.broadcast_to(along, (*shape, 3))).reshape(-1, 3)
        if not np.isfinite(rays).all():
            raise ValueError('directions are finite')
        return self._field.radiance(flat, rays).reshape(*shape, 3)

    @functools.cached_property
    def _renderer(self) -> _slf.Renderer:
        return self._make_renderer()

    def render(self, camera: Camera, size: Optional[Tuple[int, int]] = None,
               background: Tuple[int, int, int] = (128, 128, 128),
               view_dependent: bool = True) -> npt.NDArray[np.uint8]:
        """A picture, uint8 [height, width, 3], display values.

        size: width and height in place of the camera's. view_dependent False: mean colours. The
        first call decodes once more, for the renderer, within the max_memory of read(). An interrupt
        (Ctrl-C) ends the drawing. Raises ValueError, InputError of a field without colours.
        """
        if not all(hasattr(camera, name) for name in ('width', 'height', 'K', 'R', 't')):
            raise TypeError(f'a Camera is needed, as orbit() gives it, not {type(camera).__name__}')
        view = camera if size is None else camera.resized(size)
        return self._renderer.render(view, colour(background, 'background'), view_dependent)

    def orbit(self, turn: float, elevation: float = 20, size: Tuple[int, int] = (800, 800),
              fov: float = 30) -> Camera:
        """A camera on a circle around the cloud, all of it in view.

        turn: 0 to 1; elevation and fov: degrees; size: width, height.
        """
        return Camera(**self._renderer.orbit(turn, elevation, *pixels(size), fov))

    def turntable(self, steps: int = 24, elevation: float = 20,
                  size: Tuple[int, int] = (400, 400)) -> Turntable:
        """Pictures of an orbit, 2 to 360 of them, which a notebook shows under a slider."""
        count = whole(steps, 'steps', 2, 360)
        return Turntable([self.render(self.orbit(step / count, elevation, size))
                          for step in range(count)], repr(self))

    def view_map(self, point: int, rows: int = 64) -> npt.NDArray[np.uint8]:
        """Colours of a point over all directions, uint8 [rows, 2 rows, 3], display values.

        Columns are azimuths about the world's z axis from -180 to 180 degrees, rows the sine of the
        elevation from 1 to -1, each at the middle of its pixel. Raises IndexError.
        """
        height = whole(rows, 'rows', 1, MOST_PIXELS // 2)
        colours = self.radiance(point, directions_of(height))
        if self.header.transfer == 'linear':
            colours = 255 * display_values(colours / 255)
        return np.clip(np.rint(colours), 0, 255).astype(np.uint8)

    def plot_view_map(self, point: int, rows: int = 64, ax: Any = None) -> Any:
        """Draws view_map() with matplotlib, axes in degrees; gives the axes.

        ax: axes to draw into; None makes a figure. Raises IndexError; ImportError without matplotlib.
        """
        return plotted(self.view_map(point, rows), f'point {point}', ax)

    def _repr_png_(self) -> Optional[bytes]:
        """What a notebook shows; nothing where integers have no meaning as colours."""
        if self.header.basis == 'none' or not len(self):
            return None
        return png(self.render(self.orbit(0.1, size=(400, 400))))


def _voxels(data: Union[Data, Ranges], region: Box) -> Tuple[int, ...]:
    """A box of the world in voxels, as `slf decode --region` has it."""
    header = _info(_slf.info(data))
    corners = np.sort(np.asarray(region, float), axis=0)
    if corners.shape != (2, 3) or not np.isfinite(corners).all():
        raise ValueError('a region is two corners of three coordinates')
    voxels = np.floor((corners - np.asarray(header.origin)) / header.step + 0.5)
    return tuple(int(v) for v in np.clip(voxels, -1, 1 << 22).reshape(-1))


def read(source: Source, *, levels: int = 0, groups: int = 0, layers: int = 0,
         max_bytes: int = 0, region: Optional[Box] = None, threads: int = 0,
         max_memory: int = 0) -> LightField:
    """Decodes a file, what an address (https://...) gives, or bytes, which are not to be changed after.

    levels: of the octree, 1 to Info.bits, fewer are a coarser cloud; groups: of planes; layers: of
    quality, 1 to 4, fewer are a coarser quantiser; max_bytes: only units that end within them;
    region: two corners of a box of the world; 0 and None are all. threads: 0 is all cores.
    max_memory: bytes that decoding may take, 0 is 2**30.
    Where less than all is asked for, no more of a file is read than that takes, and of a server that
    gives ranges no more is fetched; damage in the rest is not seen.
    A light field that moves gives its first frame (frames() has all).
    Raises DamagedError, UnsupportedError, LimitError, ArgumentError; OSError of a file.
    """
    less = any((levels, groups, layers, max_bytes)) or region is not None
    part = part_of(levels, groups, layers, max_bytes, threads, max_memory)
    with _named(source):
        return with_part(_in_parts(source) if less else _bytes(source), part, region, _decoded)


def part_of(levels: int, groups: int, layers: int, max_bytes: int, threads: int,
            max_memory: int) -> Dict[str, Any]:
    """Arguments of read() for the extension module, without the region."""
    return {
        'levels': whole(levels, 'levels', 0, 21), 'groups': whole(groups, 'groups', 0, 16),
        'layers': whole(layers, 'layers', 0, 4),
        'max_bytes': whole(max_bytes, 'max_bytes', 0, MOST_BYTES),
        'threads': whole(threads, 'threads'),
        'max_memory': whole(max_memory, 'max_memory', 0, MOST_BYTES)}


_Made = TypeVar('_Made')


def with_part(data: Union[Data, Ranges], part: Dict[str, Any], region: Optional[Box],
              make: Callable[[Union[Data, Ranges], Dict[str, Any]], _Made]) -> _Made:
    """What is made of the data and the whole part; errors name the argument."""
    part = {**part, 'region': None if region is None else _voxels(data, region)}
    try:
        return make(data, part)
    except ArgumentError as error:
        raise _of_part(error, data) from None


def _of_part(error: ArgumentError, data: Union[Data, Ranges]) -> Error:
    """Fewer levels or groups than the file has can be asked for: says how many it has."""
    has = {'levels': 'bits', 'groups': 'groups'}.get(error.element)
    if has is None:
        return error
    most = getattr(_info(_slf.info(data)), has)
    return wrong(error.element, f'{error.element} of this file are 1 to {most}; 0 is all')


def _decoded(data: Union[Data, Ranges], part: Dict[str, Any]) -> LightField:
    return LightField(_slf.Field(data, **part), lambda: _slf.Renderer(data, **part),
                      lambda: (_decoded, (_kept(data), part)))


def _kept(data: Union[Data, Ranges]) -> Data:
    """Bytes that can be pickled."""
    if isinstance(data, (FileRanges, UrlRanges)):
        return whole_of(data)
    return bytes(data) if isinstance(data, memoryview) else data
