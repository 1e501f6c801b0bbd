# SPDX-License-Identifier: Apache-2.0
"""The colours of a point over all directions, as a picture: columns are azimuths, rows sines of the elevation."""
from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import numpy.typing as npt

_ELEVATIONS = (-90, -45, -20, 0, 20, 45, 90)  #: degrees, ticks of a plot


def directions_of(height: int) -> npt.NDArray[np.float64]:
    """Unit vectors of the middles of pixels, [height, 2 height, 3]."""
    sine = 1 - (2 * np.arange(height)[:, None] + 1) / height
    azimuth = np.pi * ((np.arange(2 * height)[None, :] + 0.5) / height - 1)
    across = np.sqrt(1 - sine**2)
    return np.stack(np.broadcast_arrays(across * np.cos(azimuth), across * np.sin(azimuth), sine), axis=-1)


def display_values(linear: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Display values of linear ones, 0 to 1 (IEC 61966-2-1)."""
    light = np.clip(linear, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light**(1 / 2.4) - 0.055)


def plotted(picture: npt.NDArray[np.uint8], title: str, ax: Any) -> Any:
    """The picture in axes of matplotlib, of a new figure where there are none; ticks are degrees."""
    if ax is None:
        ax = importlib.import_module('matplotlib.pyplot').figure().add_subplot()
    ax.imshow(picture, extent=(-180, 180, -1, 1), aspect='auto')
    ax.set_xticks(range(-180, 181, 60))
    ax.set_yticks(np.sin(np.radians(_ELEVATIONS)), [str(e) for e in _ELEVATIONS])
    ax.set(xlabel='azimuth, degrees', ylabel='elevation, degrees', title=title)
    return ax
