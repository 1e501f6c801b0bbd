# SPDX-License-Identifier: Apache-2.0
"""Encoding: of photographs and points, of given integers."""
from __future__ import annotations

import dataclasses
import os
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _slf
from ._arguments import MOST_BYTES, real, whole, whole_array, wrong
from ._types import Capture, Encoded, Vector


def encode(capture: Union[str, 'os.PathLike[str]', Capture], *, q: Optional[float] = None,
           quality_loss: Optional[float] = None, split: str = '', preset: str = 'default', effort: int = 7,
           target_bytes: int = 0, target_psnr: float = 0, grid_bits: int = 0, voxel_size: float = 0,
           normal_bits: int = 0, quality_layers: int = 1, threads: int = 0,
           progress: Optional[Callable[[str, float], object]] = None) -> Encoded:
    """From photographs and points to a stream.

    capture: a directory or file as docs/captures.md says, or a Capture. q: quantiser step in grey
    levels, 0.05 to 4096, smaller is better; None is the largest that costs held-out input images
    quality_loss dB of PSNR at most, 0.001 to 10 (None is 0.1); 16 where there are no images, nothing
    is fitted to pictures, or of preset 'paper'. split: which images, as `slf encode --split`. preset:
    'default' or 'paper'; effort: 1 to 8. target_bytes or target_psnr: in place of q. grid_bits 1 to 21, or voxel_size: 0 is what the photographs resolve. normal_bits:
    0 or 4 to 12. quality_layers: 1 to 4, each at half of the step of the one before, so that quality
    is a cut of the file (read(layers=...), max_bytes). progress(stage, fraction 0 to 1): now and then; what it raises ends the
    encoding, as an interrupt (Ctrl-C) does.
    Raises InputError, ArgumentError, ValueError.
    """
    if preset not in ('default', 'paper'):
        raise wrong('preset', "preset is 'default' or 'paper'")
    options: Dict[str, Any] = {
        'q': None if q is None else real(q, 'q', 0.05, 4096),
        'quality_loss': None if quality_loss is None else real(quality_loss, 'quality_loss', 0.001, 10),
        'preset': preset,
        'effort': whole(effort, 'effort', 1, 8),
        'target_bytes': whole(target_bytes, 'target_bytes', 0, MOST_BYTES),
        'target_psnr': real(target_psnr, 'target_psnr', 0, 100),
        'grid_bits': whole(grid_bits, 'grid_bits', 0, 21),
        'voxel_size': real(voxel_size, 'voxel_size', 0, 1e12),
        'normal_bits': whole(normal_bits, 'normal_bits', 0, 12),
        'quality_layers': whole(quality_layers, 'quality_layers', 1, 4),
        'threads': whole(threads, 'threads')}
    if quality_loss is not None and (q is not None or preset == 'paper' or target_bytes or target_psnr):
        raise wrong('quality_loss',
                    'quality_loss is of a q that is chosen: give neither q nor a target, nor preset paper')
    if 0 < options['normal_bits'] < 4:
        raise wrong('normal_bits', 'normal_bits is 0 or 4 to 12')
    if options['grid_bits'] and options['voxel_size']:
        raise wrong('voxel_size', 'voxel_size is in place of grid_bits: give one of them')
    if isinstance(capture, Capture):
        data, report = _slf.encode_capture(_in_bytes(capture), split, options, progress)
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
    voxels = whole_array(positions, 'positions', np.int32)
    planes = None if components is None else whole_array(components, 'components', np.int32)
    quantisers = None if steps is None else whole_array(steps, 'steps', np.uint32)
    if not whole(bits, 'bits', 0, 21):
        bits = max(1, int(voxels.max()).bit_length()) if voxels.size else 1
    return _slf.pack(voxels, planes, bits, origin, step, quantisers,
                     [whole(group, 'groups', 0, 15) for group in groups], list(metadata),
                     whole(threads, 'threads'))


def _in_bytes(capture: Capture) -> Capture:
    """With the colours and the images that the encoder takes."""
    colours = capture.colours
    return dataclasses.replace(
        capture, images=[whole_array(image, 'images', np.uint8) for image in capture.images],
        colours=None if colours is None else whole_array(colours, 'colours', np.uint8))
