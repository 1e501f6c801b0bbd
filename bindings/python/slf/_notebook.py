# SPDX-License-Identifier: Apache-2.0
"""What notebooks show: pictures as PNG, and an orbit under a slider in plain HTML."""
from __future__ import annotations

import base64
import html
import struct
import zlib
from typing import List, Sequence

import numpy as np
import numpy.typing as npt


def png(picture: npt.NDArray[np.uint8]) -> bytes:
    """A PNG file of uint8 [height, width, 3]."""
    height, width, _ = picture.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with its filter: none
    rows[:, 1:] = picture.reshape(height, 3 * width)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    header = struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(rows.tobytes(), 6))
            + chunk(b'IEND', b''))


class Turntable:
    """Pictures around a light field, which a notebook shows under a slider."""

    def __init__(self, pictures: Sequence[npt.NDArray[np.uint8]], title: str = '') -> None:
        self.pictures: List[npt.NDArray[np.uint8]] = list(pictures)
        self.title = title

    def html(self) -> str:
        """A piece of a page that needs nothing else: pictures are in it, one is shown."""
        shown = ''.join(
            f'<img alt="" src="data:image/png;base64,{base64.b64encode(png(picture)).decode()}"'
            f'{" hidden" if place else ""}>' for place, picture in enumerate(self.pictures))
        show = ('[...this.nextElementSibling.children].forEach((picture, place) => '
                '{ picture.hidden = place != this.value; })')
        return (f'<div><input type="range" min="0" max="{len(self.pictures) - 1}" value="0" '
                f'aria-label="{html.escape(self.title or "turn", quote=True)}" '
                f'style="width: 100%; max-width: {self.pictures[0].shape[1]}px" '
                f'oninput="{html.escape(show, quote=True)}"><div>{shown}</div></div>')

    def _repr_html_(self) -> str:
        return self.html()
