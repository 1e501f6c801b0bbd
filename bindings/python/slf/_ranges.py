# SPDX-License-Identifier: Apache-2.0
"""Sources of which no more is read than a decode needs: files, and addresses on servers that give ranges."""
from __future__ import annotations

import contextlib
import http.client
import io
import os
import re
import urllib.request
from typing import IO, Any, ContextManager, Optional, Union

_FIRST = 1 << 16  #: bytes of the first request: headers and index of most files
_TIMEOUT = 60     #: seconds without a byte


class FileRanges:
    """A path, or an open file that can be sought in: read from its own beginning, wherever it stands."""

    def __init__(self, file: Union[str, os.PathLike[str], IO[bytes]]) -> None:
        self._file = file
        with self._opened() as opened:
            self.size = opened.seek(0, os.SEEK_END)

    def _opened(self) -> ContextManager[IO[bytes]]:
        if isinstance(self._file, (str, os.PathLike)):
            return open(self._file, 'rb')
        return contextlib.nullcontext(self._file)

    def read_at(self, offset: int, size: int) -> bytes:
        """The bytes, fewer where the file ends."""
        with self._opened() as opened:
            opened.seek(offset)
            return opened.read(size)


class UrlRanges:
    """A file on a server. One that changes while it is read is an OSError."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._tag: Optional[str] = None
        self._begin = b''
        self.size = 0
        with self._get(0, _FIRST) as answer:
            found = re.fullmatch(r'bytes 0-\d+/(\d+)', answer.headers.get('Content-Range', ''))
            self.ranges = answer.status == 206 and found is not None  #: else all of it is here
            self._tag = answer.headers.get('ETag')
            self._begin = answer.read(_FIRST if self.ranges else -1)
            self.size = int(found[1]) if self.ranges and found else len(self._begin)

    def _get(self, offset: int, size: int) -> http.client.HTTPResponse:
        wanted = {'Range': f'bytes={offset}-{offset + size - 1}', 'Accept-Encoding': 'identity'}
        if self._tag and not self._tag.startswith('W/'):
            wanted['If-Range'] = self._tag
        answer: http.client.HTTPResponse = urllib.request.urlopen(
            urllib.request.Request(self._address, headers=wanted), timeout=_TIMEOUT)
        return answer

    def read_at(self, offset: int, size: int) -> bytes:
        """The bytes. OSError where the server gives others."""
        if offset + size <= len(self._begin):
            return self._begin[offset:offset + size]
        with self._get(offset, size) as answer:
            if answer.status != 206 or not answer.headers.get('Content-Range', '').startswith(f'bytes {offset}-'):
                raise OSError(f'{self._address}: the server gives no bytes {offset} to {offset + size - 1} of the same file')
            return answer.read(size)


Ranges = Union[FileRanges, UrlRanges]


def is_address(source: Any) -> bool:
    """Is it one that UrlRanges takes?"""
    return isinstance(source, str) and re.match('https?://', source) is not None


def ranges_of(source: Any) -> Optional[Ranges]:
    """A source that can be read in parts; None of any other. OSError of a path or an address."""
    if is_address(source):
        return UrlRanges(source)
    if isinstance(source, (str, os.PathLike)):
        return FileRanges(source)
    seekable = getattr(source, 'seekable', None)
    if isinstance(source, io.IOBase) and callable(seekable) and seekable():
        return FileRanges(source)  # type: ignore[arg-type]
    return None


def whole_of(ranges: Ranges) -> bytes:
    """All bytes."""
    return ranges.read_at(0, ranges.size)
