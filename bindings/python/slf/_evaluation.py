# SPDX-License-Identifier: Apache-2.0
"""Quality of a file against its photographs."""
from __future__ import annotations

import math
import os
from typing import Any, Callable, Dict, Optional, Sequence, Union

from . import _slf
from ._arguments import MOST_BYTES, whole, wrong
from ._encoding import in_bytes
from ._parts import info_of
from ._sources import bytes_of, named
from ._types import Capture, Evaluation, PictureQuality, PointQuality, Quality, Source


def eval(source: Source, capture: Union[str, 'os.PathLike[str]', Capture], *, split: str = '',
         deltas: Sequence[float] = (10,), images: bool = True, match_exposure: bool = False,
         align_cameras: bool = False, threads: int = 0, max_memory: int = 0,
         progress: Optional[Callable[[str, float], object]] = None) -> Evaluation:
    """How near a file comes to its photographs, as `slf eval` measures it (specification, annex D).

    capture: as of encode(). split: which photographs were input; '' is what the file says. deltas:
    angles to the normal within which points are judged, degrees, 0 to 90. images: pictures too, which
    takes longer. match_exposure: each picture is multiplied by what brings it nearest to its
    photograph. align_cameras: each picture is first moved by up to 4 pixels. progress: as of encode().
    Of frames in time the first is measured; the program measures all.
    Raises what read() raises, InputError of a capture, ArgumentError.
    """
    angles = [float(delta) for delta in deltas]
    if not angles or not all(math.isfinite(a) and 0 <= a <= 90 for a in angles):
        raise wrong('deltas', f'deltas are numbers of 0 to 90, not {deltas!r:.40}')
    given = in_bytes(capture) if isinstance(capture, Capture) else os.fspath(capture)
    with named(source):
        data = bytes_of(source)
        pair = _slf.evaluate(data, given, split, angles, bool(images), bool(match_exposure),
                             bool(align_cameras), whole(threads, 'threads'),
                             whole(max_memory, 'max_memory', 0, MOST_BYTES),
                             list(info_of(data).metadata), progress)
    return Evaluation(*(None if one is None else _quality(one) for one in pair))


def _quality(fields: Dict[str, Any]) -> Quality:
    return Quality(fields['cameras'], tuple(PointQuality(**p) for p in fields['points']),
                   None if fields['image'] is None else PictureQuality(**fields['image']))
