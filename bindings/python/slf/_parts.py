# SPDX-License-Identifier: Apache-2.0
"""What of a stream is decoded: levels, groups, layers, a region."""
from __future__ import annotations

from typing import Any, Callable, Dict, Optional, Tuple, TypeVar

import numpy as np

from . import _slf
from ._arguments import MOST_BYTES, whole, wrong
from ._errors import ArgumentError, Error
from ._sources import Parts
from ._types import Box, Info

_Made = TypeVar('_Made')


def info_of(data: Parts) -> Info:
    """What its headers say."""
    return Info(**_slf.info(data))


def part_of(levels: int, groups: int, layers: int, max_bytes: int, threads: int,
            max_memory: int) -> Dict[str, Any]:
    """Arguments of read() for the extension module, without the region."""
    return {
        'levels': whole(levels, 'levels', 0, 21), 'groups': whole(groups, 'groups', 0, 16),
        'layers': whole(layers, 'layers', 0, 4),
        'max_bytes': whole(max_bytes, 'max_bytes', 0, MOST_BYTES),
        'threads': whole(threads, 'threads'),
        'max_memory': whole(max_memory, 'max_memory', 0, MOST_BYTES)}


def voxels_of(data: Parts, region: Box) -> Tuple[int, ...]:
    """A box of the world in voxels, as `slf decode --region` has it."""
    header = info_of(data)
    corners = np.sort(np.asarray(region, float), axis=0)
    if corners.shape != (2, 3) or not np.isfinite(corners).all():
        raise ValueError('a region is two corners of three coordinates')
    voxels = np.floor((corners - np.asarray(header.origin)) / header.step + 0.5)
    return tuple(int(v) for v in np.clip(voxels, -1, 1 << 22).reshape(-1))


def with_part(data: Parts, part: Dict[str, Any], region: Optional[Box],
              make: Callable[[Any, Dict[str, Any]], _Made]) -> _Made:
    """What is made of the data and the whole part; errors name the argument."""
    part = {**part, 'region': None if region is None else voxels_of(data, region)}
    try:
        return make(data, part)
    except ArgumentError as error:
        raise of_part(error, lambda: info_of(data)) from None


def of_part(error: ArgumentError, header: Callable[[], Info]) -> Error:
    """Fewer levels, groups or layers than the file has can be asked for: says how many it has."""
    has = {'levels': 'bits', 'groups': 'groups', 'layers': 'layers'}.get(error.element)
    if has is None:
        return error
    most = getattr(header(), has)
    return wrong(error.element, f'{error.element} of this file are 1 to {most}; 0 is all')
