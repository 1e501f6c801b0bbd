# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the package."""
from __future__ import annotations


class Error(Exception):
    """What the library refused. Its message is one line that names the cause.

    code: 'SLF_TRUNCATED' and so on, as slf/slf.h and docs/cli.md list them
    element: the name in the specification's syntax tables, or of the argument; may be empty
    unit: of the stream, 'geometry' and so on; may be empty
    bit_offset: where in the stream
    """

    code: str = 'SLF_INTERNAL'
    element: str = ''
    unit: str = ''
    bit_offset: int = 0


class DamagedError(Error):
    """Not an .slf stream, or one that is cut short or damaged."""


class UnsupportedError(Error):
    """Another format version, an unknown profile, or a part that was left out of this build."""


class LimitError(Error):
    """Sound, but larger than the limits or the memory."""


class ArgumentError(Error, ValueError):
    """An argument outside of its documented range."""


class InputError(Error):
    """A capture that is missing, cannot be read, or cannot be used."""


_CLASSES: dict[str, type[Error]] = {
    'SLF_NOT_SLF': DamagedError,
    'SLF_TRUNCATED': DamagedError,
    'SLF_CHECKSUM': DamagedError,
    'SLF_OUT_OF_RANGE': DamagedError,
    'SLF_RESERVED': DamagedError,
    'SLF_UNSUPPORTED': UnsupportedError,
    'SLF_LIMIT_EXCEEDED': LimitError,
    'SLF_OUT_OF_MEMORY': LimitError,
    'SLF_INVALID_ARGUMENT': ArgumentError,
    'SLF_UNREADABLE': InputError,
    'SLF_INVALID_INPUT': InputError,
}


EMPTY = 'the file is empty'


def of_source(error: Error, name: str) -> Error:
    """The same error, which says what of. What is no stream at all is said to be none."""
    what = 'not an .slf file' if error.code == 'SLF_NOT_SLF' and str(error) != EMPTY else str(error)
    return make(error.code, f'{name}: {what}', error.element, error.unit, error.bit_offset)


def make(code: str, message: str, element: str, unit: str, bit_offset: int) -> Error:
    """The exception for a failure of the library. Called by the extension module."""
    error = _CLASSES.get(code, Error)(message)
    error.code, error.element, error.unit, error.bit_offset = code, element, unit, bit_offset
    return error
