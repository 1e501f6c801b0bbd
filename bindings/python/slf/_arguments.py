# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments: what is wrong is named, and nothing is rounded or cut."""
from __future__ import annotations

import math
import numbers
import operator
from typing import Any, Tuple, Type, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _errors

MOST_BYTES = 2**64 - 1  #: of the C interface
MOST_PIXELS = 16384  #: of a side
FOV = (1, 170)  #: degrees, as the program has them
ELEVATION = (-90, 90)
MOST_METRES = 1e12  #: per unit of a world

_Any = TypeVar('_Any', bound=np.generic)
_Whole = TypeVar('_Whole', bound='np.integer[Any]')


def wrong(name: str, message: str) -> _errors.Error:
    """An ArgumentError, which is a ValueError."""
    return _errors.make('SLF_INVALID_ARGUMENT', message, name, '', 0)


def whole(value: Any, name: str, low: int = 0, high: int = 2**31 - 1) -> int:
    """A whole number of any type."""
    try:
        number = operator.index(value)
    except TypeError:
        number = low - 1
    if not low <= number <= high:
        raise wrong(name, f'{name} is a whole number of {low} to {high}, not {value!r:.40}')
    return number


def number(value: Any, name: str, low: float = -math.inf, high: float = math.inf) -> Union[int, float]:
    """A finite number of any type, of numpy's too, as one of Python's own."""
    given = value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value
    made: Union[int, float] = math.nan
    if isinstance(given, numbers.Integral):
        made = int(given)
    elif isinstance(given, numbers.Real):
        made = float(given)
    if math.isfinite(made) and low <= made <= high:
        return made
    limits = f' of {low:g} to {high:g}' if math.isfinite(low) else ''
    raise wrong(name, f'{name} is a number{limits}, not {value!r:.40}')


def pixels(size: Tuple[int, int]) -> Tuple[int, int]:
    """Width and height of a picture."""
    sides = tuple(size) if np.iterable(size) else ()
    if len(sides) != 2:
        raise wrong('size', f'size is width and height, not {size!r:.40}')
    width, height = sides
    return whole(width, 'width', 1, MOST_PIXELS), whole(height, 'height', 1, MOST_PIXELS)


def colour(value: Any, name: str) -> Tuple[int, int, int]:
    """Red, green and blue of 8 bits."""
    channels = tuple(value) if np.iterable(value) else ()
    if len(channels) != 3:
        raise wrong(name, f'{name} is three whole numbers, not {value!r:.40}')
    red, green, blue = (whole(c, name, 0, 255) for c in channels)
    return red, green, blue


def whole_array(values: npt.ArrayLike, name: str, kind: Type[_Whole]) -> npt.NDArray[_Whole]:
    """Values as an array of a kind; of another type only where that has no fractions and no value is lost."""
    array = np.asarray(values)
    limits = np.iinfo(kind)
    if array.dtype.kind not in 'iu' or (array.dtype != kind and array.size and not (
            limits.min <= array.min() and array.max() <= limits.max)):
        raise wrong(name, f'{name} are whole numbers of {limits.min} to {limits.max}')
    return array.astype(kind, copy=False)


def colours8(values: npt.ArrayLike, name: str) -> npt.NDArray[np.uint8]:
    """R, G, B of 8 bits, [N, 3]: of whole numbers 0 to 255, or of floats 0 to 1. An alpha is left out."""
    array = np.asarray(values)
    if array.dtype.kind == 'f':
        if array.size and not (np.isfinite(array).all() and 0 <= array.min() and array.max() <= 1):
            raise wrong(name, f'{name} that are floats are 0 to 1; whole numbers are 0 to 255')
        array = np.rint(255 * array).astype(np.uint8)
    colours = whole_array(array, name, np.uint8)
    return np.ascontiguousarray(colours[:, :3]) if colours.ndim == 2 and colours.shape[1] == 4 else colours


def fixed(array: npt.NDArray[_Any]) -> npt.NDArray[_Any]:
    """The array, which is not to be written to any more."""
    array.flags.writeable = False
    return array
