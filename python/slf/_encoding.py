"""Encoding: of photographs and points, of given integers."""
from __future__ import annotations

import os
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _slf
from ._types import Capture, Encoded, Vector


def encode(capture: Union[str, 'os.PathLike[str]', Capture], *, q: Optional[float] = None,
           split: str = '', preset: str = 'default', effort: int = 7, target_bytes: int = 0,
           target_psnr: float = 0, grid_bits: int = 0, voxel_size: float = 0,
           normal_bits: int = 0, quality_layers: int = 1, threads: int = 0,
           progress: Optional[Callable[[str, float], object]] = None) -> Encoded:
    """From photographs and points to a stream.

    capture: a directory or file as docs/captures.md says, or a Capture. q: quantiser step in grey
    levels, 0.05 to 4096, smaller is better (default: the preset's, 16). split: which images, as
    `slf encode --split`. preset: 'default' or 'paper'; effort: 1 to 8. target_bytes or target_psnr:
    in place of q. grid_bits 1 to 21 or voxel_size: 0 is what the photographs resolve. normal_bits:
    0 or 4 to 12. quality_layers: 1 to 4, each at half of the step of the one before, so that quality
    is a cut of the file (read(layers=...), max_bytes). progress(stage, fraction 0 to 1): now and then; what it raises is raised at the end.
    Raises InputError, ArgumentError, ValueError.
    """
    if preset not in ('default', 'paper') or not 1 <= effort <= 8:
        raise ValueError("preset is 'default' or 'paper', and effort 1 to 8")
    options: Dict[str, Any] = {
        'q': q, 'preset': preset, 'effort': effort, 'target_bytes': target_bytes,
        'target_psnr': target_psnr, 'grid_bits': grid_bits, 'voxel_size': voxel_size,
        'normal_bits': normal_bits, 'quality_layers': quality_layers, 'threads': threads}
    if isinstance(capture, Capture):
        data, report = _slf.encode_capture(capture, split, options, progress)
    else:
        data, report = _slf.encode_path(os.fspath(capture), split, options, progress)
    report['warnings'] = tuple(report['warnings'])
    return Encoded(data, **report)


def pack(positions: npt.ArrayLike, components: Optional[npt.ArrayLike] = None, *, bits: int = 0,
         origin: Vector = (0.0, 0.0, 0.0), step: float = 1.0,
         steps: Optional[npt.ArrayLike] = None, groups: Sequence[int] = (),
         metadata: Sequence[Tuple[str, str]] = (), threads: int = 0) -> bytes:
    """Codes given integers: voxels, exactly, and planes of any meaning.

    positions [P, 3], 0 to 2^bits - 1, no two alike; components [P, K, 3], 32 bits signed; bits: 0 is
    what the positions take; steps [K, 3]: quantiser steps, 1 or more, None is 1: transforms round, so
    that values come back within a few units; groups [K]: 0 to 15.
    Raises ArgumentError, ValueError.
    """
    voxels = _whole(positions, 'positions')
    planes = None if components is None else _whole(components, 'components')
    if not bits:
        bits = max(1, int(voxels.max()).bit_length()) if voxels.size else 1
    return _slf.pack(voxels, planes, bits, origin, step, steps, list(groups), list(metadata),
                     threads)


def _whole(values: npt.ArrayLike, name: str) -> npt.NDArray[np.int32]:
    array = np.asarray(values)
    limits = np.iinfo(np.int32)
    if array.dtype.kind not in 'iu' or (
            array.size and not (limits.min <= array.min() and array.max() <= limits.max)):
        raise ValueError(f'{name} are whole numbers of 32 bits')
    return array.astype(np.int32, copy=False)
