# SPDX-License-Identifier: Apache-2.0
"""Sources of which no more is read than a decode needs, and which keep what was read."""
from __future__ import annotations

import bisect
import contextlib
import http.client
import os
import re
import urllib.error
import urllib.request
from typing import IO, Any, Dict, Iterator, List, Optional, Union

_FIRST = 1 << 16  #: bytes of the first request: headers and index of most files
_TIMEOUT = 60     #: seconds without a byte


def can_seek(file: Any) -> bool:
    """Is it an open file of which any place can be read?"""
    asked = getattr(file, 'seekable', None)  # temporary files of Python before 3.11 have none
    return bool(asked()) if callable(asked) else hasattr(file, 'seek') and hasattr(file, 'tell')


@contextlib.contextmanager
def from_beginning(file: IO[bytes]) -> Iterator[None]:
    """Within this a file that can be sought in stands at its beginning, and after it where it stood before."""
    if not can_seek(file):
        yield
        return
    stood = file.tell()
    file.seek(0)
    try:
        yield
    finally:
        file.seek(stood)


class FileRanges:
    """An open file that can be sought in."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self.name = str(getattr(file, 'name', 'the file'))
        self.size = file.seek(0, os.SEEK_END)

    def read_at(self, offset: int, size: int) -> bytes:
        """The bytes, fewer where the file ends."""
        self._file.seek(offset)
        data = self._file.read(size)
        while len(data) < size:  # an unbuffered file gives what it has at once
            more = self._file.read(size - len(data))
            if not more:
                break
            data += more
        return data


class UrlRanges:
    """A file on a server. One that changes while it is read is an OSError."""

    def __init__(self, address: str) -> None:
        self.name = address
        self._tag: Optional[str] = None
        self._begin = b''
        self.size = 0
        try:
            first = self._get(0, _FIRST)
        except urllib.error.HTTPError as error:
            if error.code != 416:  # no first byte: the file is empty, and what reads it says so
                raise
            error.close()
            self.ranges = False
            return
        with first as answer:
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
            urllib.request.Request(self.name, headers=wanted), timeout=_TIMEOUT)
        return answer

    def read_at(self, offset: int, size: int) -> bytes:
        """The bytes. OSError where the server gives others."""
        if offset + size <= len(self._begin):
            return self._begin[offset:offset + size]
        with self._get(offset, size) as answer:
            if answer.status != 206 or not answer.headers.get('Content-Range', '').startswith(f'bytes {offset}-'):
                raise OSError(f'{self.name}: the server gives no bytes {offset} to {offset + size - 1} of the same file')
            return answer.read(size)


Ranges = Union[FileRanges, UrlRanges]


class KeptRanges:
    """What was read of a source. Until close() the rest is read when it is asked for; after it there is no source any more."""

    def __init__(self, source: Ranges) -> None:
        self._source: Optional[Ranges] = source
        self.name, self.size = source.name, source.size
        self._begins: List[int] = []  #: ascending, and so are the ends of the pieces
        self._pieces: Dict[int, bytes] = {}  #: by where they begin

    def close(self) -> None:
        """Lets go of the source."""
        self._source = None

    def read_at(self, offset: int, size: int) -> bytes:
        """The bytes. OSError where the source gives fewer, or is no more."""
        kept = self._kept(offset, offset + size)
        if kept is not None:
            return kept
        if self._source is None:
            raise OSError(f'{self.name}: bytes {offset} to {offset + size - 1} were not read when it was decoded')
        data = self._source.read_at(offset, size)
        if len(data) != size:
            raise OSError(f'{self.name}: ended at byte {offset + len(data)} while it was read; it had {self.size} bytes')
        self._keep(offset, data)
        return data

    def _kept(self, offset: int, end: int) -> Optional[bytes]:
        found: List[bytes] = []
        while offset < end:
            place = bisect.bisect_right(self._begins, offset) - 1
            begin = self._begins[place] if place >= 0 else 0
            piece = self._pieces[begin][offset - begin:end - begin] if place >= 0 else b''
            if not piece:
                return None
            found.append(piece)
            offset += len(piece)
        return b''.join(found)

    def _keep(self, offset: int, data: bytes) -> None:
        """In place of pieces that it has within."""
        first = last = bisect.bisect_left(self._begins, offset)
        while last < len(self._begins) and self._begins[last] + len(self._pieces[self._begins[last]]) <= offset + len(data):
            del self._pieces[self._begins[last]]
            last += 1
        self._begins[first:last] = [offset]
        self._pieces[offset] = data


def is_address(source: Any) -> bool:
    """Is it one that UrlRanges takes?"""
    return isinstance(source, str) and re.match('https?://', source) is not None


def whole_of(ranges: Ranges) -> bytes:
    """All bytes."""
    return ranges.read_at(0, ranges.size)
