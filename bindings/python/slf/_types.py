# SPDX-License-Identifier: Apache-2.0
"""Values that functions of slf take and give."""
from __future__ import annotations

import contextlib
import dataclasses
import math
import os
import secrets
from typing import IO, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._arguments import FOV, number, pixels, wrong

#: A path, an address (http:// or https://), bytes, or a file that is open for reading bytes.
Source = Union[str, 'os.PathLike[str]', bytes, bytearray, memoryview, IO[bytes]]
Vector = Tuple[float, float, float]
Box = Tuple[Sequence[float], Sequence[float]]
UP = ('+x', '-x', '+y', '-y', '+z', '-z', 'unknown')  #: by the numbers of slf::UpAxis


@dataclasses.dataclass(frozen=True)
class Info:
    """What a stream's headers say (slf_info of slf/slf.h)."""

    format_version: Tuple[int, int]
    profile: str  #: 'main', 'draco' (geometry) or 'texture'
    bytes: int
    points: int
    functions: int  #: K
    components: int  #: R, the coded ones
    slices: int
    groups: int  #: of planes: what read(groups=...) counts
    layers: int  #: of quality, of the group that has most: what read(layers=...) counts
    bits: int  #: of the grid, levels of the octree: what read(levels=...) counts
    normal_bits: int  #: of coded normals; 0: none
    has_splats: bool  #: points are Gaussian splats: opacities and covariances of the field
    origin: Vector  #: world position of voxel (0, 0, 0)
    step: float  #: world units from voxel to voxel
    metres_per_unit: float  #: 0: not known
    up: str  #: '+x', '-x', ... or 'unknown'
    right_handed: bool
    basis: str  #: 'bspline', 'harmonics' or 'none': integers without a meaning
    directions: str  #: 'world' or 'reflected'
    transfer: str  #: 'display' or 'linear': what colours are of
    gamma_range: Tuple[float, float]
    complete: bool  #: False: the end of the stream is missing
    metadata: Tuple[Tuple[str, str], ...]


@dataclasses.dataclass(frozen=True)
class Frame:
    """A frame of a light field that moves, as its frame unit says (slf_frame of slf/slf.h)."""

    number: int  #: ascending
    time: float  #: seconds, ascending
    predicted: bool  #: from the frame before it
    lost: bool  #: none could be read here; it stands for one or several
    offset: int  #: of its first byte in the stream
    bytes: int


@dataclasses.dataclass(eq=False)
class Camera:
    """A pinhole camera with OpenCV axes: x_cam = R x + t, x right, y down, z forward.

    K: [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]; R: a rotation, [3, 3]; t [3]; the centre of the top left
    pixel is (0.5, 0.5). distortion: k1, k2, p1, p2 of OpenCV. What takes a camera raises ValueError
    for another.
    """

    width: int
    height: int
    K: npt.ArrayLike
    R: npt.ArrayLike
    t: npt.ArrayLike
    distortion: npt.ArrayLike = (0.0, 0.0, 0.0, 0.0)
    name: str = 'camera'

    @classmethod
    def look_at(cls, eye: npt.ArrayLike, target: npt.ArrayLike, up: npt.ArrayLike = (0, 0, 1),
                size: Tuple[int, int] = (800, 800), fov: float = 30) -> Camera:
        """A camera at `eye` that has `target` in its middle.

        size: width and height; fov: degrees, 1 to 170, of the larger of them. Raises ValueError.
        """
        width, height = pixels(size)
        fov = number(fov, 'fov', *FOV)
        position = np.asarray(eye, float)
        forward = np.asarray(target, float) - position
        right = np.cross(forward, np.asarray(up, float))
        if not np.linalg.norm(right) > 0:
            raise ValueError('the camera looks along `up`, or at itself')
        forward, right = forward / np.linalg.norm(forward), right / np.linalg.norm(right)
        rotation = np.stack([right, np.cross(forward, right), forward])
        focal = max(width, height) / 2 / math.tan(math.radians(fov) / 2)
        intrinsics = np.diag([focal, focal, 1.0])
        intrinsics[:2, 2] = width / 2, height / 2
        return cls(width, height, intrinsics, rotation, -rotation @ position)

    def resized(self, size: Tuple[int, int]) -> Camera:
        """The same view in another number of pixels (width, height)."""
        width, height = pixels(size)
        scale = np.diag([width / self.width, height / self.height, 1.0])
        return dataclasses.replace(self, width=width, height=height,
                                   K=scale @ np.asarray(self.K, float))


@dataclasses.dataclass(eq=False)
class Capture:
    """Photographs and points in memory; a directory of files needs none of this (encode).

    points [N, 3] world; normals [N, 3] unit, outward, or None; colours [N, 3 or 4] or None: whole
    numbers of 0 to 255, as trimesh has them, or floats of 0 to 1, as open3d has them; an alpha is left
    out. images: uint8 [height, width, 3 or 4] of each camera, display values, alpha 0 off the object; of
    another type of whole numbers where they are 0 to 255.
    """

    points: npt.ArrayLike
    normals: Optional[npt.ArrayLike] = None
    colours: Optional[npt.ArrayLike] = None
    cameras: Sequence[Camera] = ()
    images: Sequence[npt.ArrayLike] = ()
    up: str = '+z'

    @property
    def up_index(self) -> int:
        """The number that slf::UpAxis has for it."""
        if self.up not in UP:
            raise wrong('up', f'up is {", ".join(UP)}, not {self.up!r:.40}')
        return UP.index(self.up)


@dataclasses.dataclass(frozen=True)
class PointQuality:
    """Colours of points against photographs, of the views within `delta` degrees of the normal."""

    delta: float
    psnr: float  #: dB, over points, cameras and channels; infinite where nothing differs
    luma_psnr: float
    channel_psnr: Tuple[float, float, float]
    observations: int


@dataclasses.dataclass(frozen=True)
class PictureQuality:
    """Pictures against photographs, where both show the object."""

    psnr: float  #: dB
    ssim: float
    ms_ssim: float
    psnr_all: float  #: of every pixel
    coverage: float  #: share of the object's pixels that the pictures cover
    off_pixels: float  #: how far a picture would have to move to lie on its photograph
    psnr_each: Tuple[float, ...]  #: of each camera


@dataclasses.dataclass(frozen=True)
class Quality:
    """What was measured on one set of cameras."""

    cameras: int
    points: Tuple[PointQuality, ...]  #: for each delta; of splats none
    image: Optional[PictureQuality]  #: None where pictures were not asked for


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """What eval() measured."""

    input: Optional[Quality]  #: of the photographs that the file was made from; None: it names none
    held_out: Optional[Quality]  #: of those that it was not made from


@dataclasses.dataclass(frozen=True)
class Encoded:
    """What encode() made."""

    data: bytes = dataclasses.field(repr=False)  #: the stream
    q: float  #: the quantiser step it was coded with
    points: int
    bits: int  #: of the grid
    step: float  #: world units from voxel to voxel
    observations: int
    warnings: Tuple[str, ...]  #: of the capture, then of its encoding

    def write(self, path: Union[str, 'os.PathLike[str]']) -> None:
        """To a temporary file beside `path`, renamed over it."""
        temporary = f'{os.fspath(path)}.tmp{secrets.token_hex(8)}'
        try:
            self._write(temporary, path)
        except OSError as error:  # a temporary name tells nobody anything
            raise type(error)(error.errno, error.strerror, os.fspath(path)) from None

    def _write(self, temporary: str, path: Union[str, 'os.PathLike[str]']) -> None:
        file = open(temporary, 'xb')  # outside of try: a file that was there is another writer's
        try:
            with file:
                file.write(self.data)
            os.replace(temporary, path)
        except BaseException:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(temporary)
            raise
