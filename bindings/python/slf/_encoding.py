# SPDX-License-Identifier: Apache-2.0
"""Encoding: of photographs and points, of given integers."""
from __future__ import annotations

import dataclasses
import os
import re
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _slf
from ._arguments import colours8, number, whole, whole_array, wrong
from ._errors import ArgumentError, Error
from ._notes import Notes, notes_text
from ._types import Capture, Encoded, Vector


_Value = Union[str, int, float, bool, None]


def settings() -> Dict[str, Dict[str, Any]]:
    """The encoder's settings: for each name low and high, words, initial value and a sentence of help.

    They are those of `slf settings`, and arguments of encode().
    """
    return {row.pop('name').replace('-', '_'): row for row in _slf.settings()}


def encode(capture: Union[str, 'os.PathLike[str]', Capture], *, q: _Value = None, split: str = '',
           notes: Optional[Notes] = None, threads: int = 0,
           progress: Optional[Callable[[str, float], object]] = None, **settings: _Value) -> Encoded:
    """From photographs and points to a stream.

    capture: a directory or file as docs/captures.md says, or a Capture. q: quantiser step in grey
    levels, 0.05 to 4096, smaller is better; None is the largest that costs held-out input images
    quality_loss dB of PSNR at most, or 16 where nothing can be held out. split: which images, as
    `slf encode --split`; the file records it, and eval() takes none of them for held out. notes:
    points with text and guided tours, which viewers show, as a file or a dict (docs/notes.md).
    settings: all that the program has, by its names with _ for -, as numbers, words, True or False,
    None where it is not given: effort=3, target_bytes=50000, surface='trained', grid_bits=9,
    quality_layers=3. slf.settings() lists them with their ranges. Those for photographs are refused
    of points alone, as by the program.
    progress(stage, fraction 0 to 1): now and then; what it raises ends the encoding, as an interrupt
    (Ctrl-C) does.
    Raises InputError, ArgumentError, ValueError.
    """
    options = dict(_option(name, value) for name, value in {'q': q, **settings}.items()
                   if value is not None)
    threads = whole(threads, 'threads')
    metadata = [] if notes is None else [('notes', notes_text(notes))]
    try:
        if isinstance(capture, Capture):
            data, report = _slf.encode_capture(in_bytes(capture), split, options, metadata, threads, progress)
        else:
            data, report = _slf.encode_path(os.fspath(capture), split, options, metadata, threads, progress)
    except ArgumentError as error:
        raise _of_arguments(error) from None
    report['warnings'] = tuple(report['warnings'])
    return Encoded(data, **report)


def _option(name: str, value: _Value) -> Tuple[str, str]:
    """Name and text as the program has them."""
    option = 'quality' if name == 'q' else name.replace('_', '-')
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)):
        text = 'on' if value else 'off'
    elif isinstance(value, (float, np.floating)):
        text = repr(float(value))
    else:
        text = str(value)
    what = _slf.wrong_value(option, text)
    if what:
        raise wrong(name, f'{name} {what}')
    return option, text


def _of_arguments(error: ArgumentError) -> Error:
    """An error that begins with an option, --grid-bits, is of the argument grid_bits."""
    found = re.match(r'--([a-z0-9-]+) ', str(error))
    if not found:
        return error
    text = re.sub(r'--([a-z0-9-]+)', lambda option: _argument(option[1]), str(error))
    return wrong(_argument(found[1]), text)


def _argument(option: str) -> str:
    return 'q' if option == 'quality' else option.replace('-', '_')


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
    bits = whole(bits, 'bits', 0, 21)
    if not bits:
        bits = max(1, int(voxels.max()).bit_length()) if voxels.size else 1
    corner = tuple(origin) if np.iterable(origin) else ()
    if len(corner) != 3:
        raise wrong('origin', f'origin is three numbers, not {origin!r:.40}')
    x, y, z = (float(number(c, 'origin')) for c in corner)
    return _slf.pack(voxels, planes, bits, (x, y, z), float(number(step, 'step')), quantisers,
                     [whole(group, 'groups', 0, 15) for group in groups], list(metadata),
                     whole(threads, 'threads'))


def in_bytes(capture: Capture) -> Capture:
    """With the colours and the images that the library takes."""
    colours = capture.colours
    return dataclasses.replace(
        capture, images=[whole_array(image, 'images', np.uint8) for image in capture.images],
        colours=None if colours is None else colours8(colours, 'colours'))
