# SPDX-License-Identifier: Apache-2.0
"""Where the bytes of a stream come from. An open file is read from its beginning and left standing where it stood."""
from __future__ import annotations

import contextlib
import io
import os
from typing import Any, Iterator, Union

from ._errors import EMPTY, DamagedError, LimitError, UnsupportedError, make, of_source
from ._ranges import FileRanges, KeptRanges, Ranges, UrlRanges, can_seek, from_beginning, is_address, whole_of
from ._types import Source

Data = Union[bytes, bytearray, memoryview]
Parts = Union[Data, KeptRanges]


def bytes_of(source: Source) -> Data:
    """All of it."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        return source
    if is_address(source):
        return whole_of(_filled(UrlRanges(str(source))))
    if isinstance(source, (str, os.PathLike)):
        with open(source, 'rb') as file:
            return file.read()
    return _all_of(source)


def _all_of(file: Any) -> Data:
    read_all = getattr(file, 'read', None)
    data = None
    if callable(read_all) and not isinstance(file, io.TextIOBase):
        with from_beginning(file):
            data = read_all()
    if not isinstance(data, (bytes, bytearray, memoryview)):
        raise TypeError(f'a path, an address, bytes or a binary file are needed, not {type(file).__name__}')
    return data


@contextlib.contextmanager
def in_parts(source: Source) -> Iterator[Parts]:
    """What no more is read of than is needed, where that can be. After this it still has what was read, and needs no source."""
    with contextlib.ExitStack() as stack:
        found = _opened(source, stack)
        if not isinstance(found, (FileRanges, UrlRanges)):
            yield found
            return
        kept = KeptRanges(found)
        stack.callback(kept.close)
        yield kept


def _opened(source: Source, stack: contextlib.ExitStack) -> Union[Data, Ranges]:
    """What is opened here is closed by the stack."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        return source
    if is_address(source):
        return _filled(UrlRanges(str(source)))
    file: Any = stack.enter_context(open(source, 'rb')) if isinstance(source, (str, os.PathLike)) else source
    if isinstance(file, io.TextIOBase) or not can_seek(file):
        return _all_of(file)
    stack.enter_context(from_beginning(file))
    return _filled(FileRanges(file))


def _filled(ranges: Ranges) -> Ranges:
    if not ranges.size:
        raise make('SLF_NOT_SLF', EMPTY, 'signature', '', 0)
    return ranges


@contextlib.contextmanager
def named(source: Source) -> Iterator[None]:
    """Errors of a stream name the path or the address that it is from."""
    try:
        yield
    except (DamagedError, UnsupportedError, LimitError) as error:
        if not isinstance(source, (str, os.PathLike)):
            raise
        raise of_source(error, os.fspath(source)) from None


def picklable(data: Parts) -> Parts:
    """The same bytes."""
    return bytes(data) if isinstance(data, memoryview) else data
