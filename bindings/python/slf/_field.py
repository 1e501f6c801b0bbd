# SPDX-License-Identifier: Apache-2.0
"""Decoding: what of a stream, its arrays, its pictures."""
from __future__ import annotations

import functools
import warnings
from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _slf
from ._arguments import ELEVATION, FOV, MOST_PIXELS, colour, fixed, number, pixels, whole, wrong
from ._notebook import Turntable, png
from ._parts import info_of, part_of, with_part
from ._sources import Parts, bytes_of, in_parts, named, picklable
from ._types import Box, Camera, Frame, Info, Source, Vector
from ._view_map import directions_of, display_values, plotted

_TRIANGLE = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])  #: of the six values of a covariance


def info(source: Source) -> Info:
    """Headers of a file, an address or bytes; nothing is decoded.

    An open file is read as by read(). If a file has an index, as `slf encode` writes it, only its beginning is read: damage behind it
    is not seen. Raises DamagedError, UnsupportedError; OSError of a file.
    """
    with named(source), in_parts(source) as data:
        return info_of(data)


def check_camera(camera: Any) -> None:
    """TypeError of what is none."""
    if not all(hasattr(camera, name) for name in ('width', 'height', 'K', 'R', 't')):
        raise TypeError(f'a Camera is needed, as orbit() gives it, not {type(camera).__name__}')


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
        """Pickled as the bytes that were read of its stream, and decoded again."""
        return self._made_by()

    def __repr__(self) -> str:
        return f'<slf.LightField of {len(self)} points, {self.header.functions} functions>'

    @functools.cached_property
    def header(self) -> Info:
        """The grid of the whole stream; bits, step and origin are those of its own grid."""
        return Info(**self._field.info())

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

    @property
    def has_splats(self) -> bool:
        """Points are Gaussian splats, with opacities and covariances."""
        return bool(self._shape['has_splats'])

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
        """Unit normals, float32 [P, 3], of either sign: coded, else estimated; 0 where unknown.

        Deprecated where has_splats is true and none are coded: an error from 2.0 on.
        """
        if self.has_splats and not self.header.normal_bits:
            self._warn_of_discs('normals')
        return fixed(self._field.normals())

    @functools.cached_property
    def radii(self) -> npt.NDArray[np.float32]:
        """Radii of the discs that a renderer draws, float32 [P], world units.

        Deprecated where has_splats is true: an error from 2.0 on.
        """
        if self.has_splats:
            self._warn_of_discs('radii')
        return fixed(self._field.radii())

    @staticmethod
    def _warn_of_discs(name: str) -> None:
        warnings.warn(f'{name} are of discs, and these points are splats: covariances have their extent', FutureWarning, stacklevel=4)

    @functools.cached_property
    def opacities(self) -> npt.NDArray[np.float32]:
        """What a splat hides at its centre of what is behind it, float32 [P], 0 to 1. Raises ArgumentError without splats."""
        self._check_splats('opacities')
        return fixed(self._field.opacities())

    @functools.cached_property
    def covariances(self) -> npt.NDArray[np.float32]:
        """Extents of splats about their points, float32 [P, 3, 3], world units squared. Raises ArgumentError without splats.

        What does not fit a float is infinite or no number, and such a splat is not drawn.
        """
        self._check_splats('covariances')
        return fixed(self._field.covariances()[:, _TRIANGLE])

    def _check_splats(self, name: str) -> None:
        if not self.has_splats:
            raise wrong(name, f'{name} are of splats, and this light field holds none (has_splats)')

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
        check_camera(camera)
        view = camera if size is None else camera.resized(size)
        return self._renderer.render(view, colour(background, 'background'), bool(view_dependent))

    def orbit(self, turn: float, elevation: float = 20, size: Tuple[int, int] = (800, 800),
              fov: float = 30) -> Camera:
        """A camera on a circle around the cloud, all of it in view.

        turn: 1 is all around; elevation: degrees, -90 to 90; fov: degrees, 1 to 170; size: width,
        height. Raises ValueError.
        """
        around, up = number(turn, 'turn'), number(elevation, 'elevation', *ELEVATION)
        return Camera(**self._renderer.orbit(around, up, *pixels(size), number(fov, 'fov', *FOV)))

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


def read(source: Source, *, levels: int = 0, groups: int = 0, layers: int = 0,
         max_bytes: int = 0, region: Optional[Box] = None, threads: int = 0,
         max_memory: int = 0) -> LightField:
    """Decodes a file, what an address (https://...) gives, or bytes, which are not to be changed after.

    An open file is read from its beginning, wherever it stands, and stands there again afterwards; one
    that cannot be sought in, as a pipe, from where it stands. The light field keeps what was read:
    the file may be closed, changed or deleted.
    levels: of the octree, 1 to Info.bits, fewer are a coarser cloud; groups: of planes; layers: of
    quality, 1 to Info.layers, fewer are a coarser quantiser; max_bytes: only units that end within them;
    region: two corners of a box of the world; 0 and None are all. threads: 0 is all cores.
    max_memory: bytes that decoding may take, 0 is 2**30.
    Where less than all is asked for, no more of a file is read than that takes, and of a server that
    gives ranges no more is fetched; damage in the rest is not seen.
    A light field that moves gives its first frame (frames() has all).
    Raises DamagedError, UnsupportedError, LimitError, ArgumentError; OSError of a file.
    """
    less = any((levels, groups, layers, max_bytes)) or region is not None
    part = part_of(levels, groups, layers, max_bytes, threads, max_memory)
    with named(source):
        if not less:
            return with_part(bytes_of(source), part, region, _decoded)
        with in_parts(source) as data:
            return with_part(data, part, region, _decoded)


def _decoded(data: Parts, part: Dict[str, Any]) -> LightField:
    return LightField(_slf.Field(data, **part), lambda: _slf.Renderer(data, **part),
                      lambda: (_decoded, (picklable(data), part)))
