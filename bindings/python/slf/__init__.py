# SPDX-License-Identifier: Apache-2.0
"""Surface light fields: read, look at, render and encode .slf files with numpy.

    import slf
    field = slf.read('can.slf')
    picture = field.render(field.orbit(0.1), (800, 600))

P is the number of points, R of coded functions of direction; colours are R, G, B of 0 to 255. Errors
of the library are slf.Error and its subclasses. Long functions let other threads of Python run.
"""
from __future__ import annotations

from . import _slf
from ._encoding import encode, pack, settings
from ._errors import (ArgumentError, DamagedError, Error, InputError, LimitError,
                      UnsupportedError)
from ._evaluation import eval
from ._field import LightField, info, read
from ._files import annotate, export, truncate
from ._frames import Frames, frames
from ._notebook import Turntable
from ._page import html
from ._types import (Camera, Capture, Encoded, Evaluation, Frame, Info, PictureQuality,
                     PointQuality, Quality)

__all__ = ['ArgumentError', 'Camera', 'Capture', 'DamagedError', 'Encoded', 'Error', 'Evaluation', 'Frame',
           'Frames', 'Info', 'InputError', 'LightField', 'LimitError', 'PictureQuality', 'PointQuality',
           'Quality', 'Turntable', 'UnsupportedError', '__version__', 'annotate', 'encode', 'eval', 'export', 'frames',
           'html', 'info', 'pack', 'read', 'settings', 'truncate']

__version__: str = _slf.version()

# Where a user finds them, in messages and in help().
for _name in ('Camera', 'Capture', 'Encoded', 'Evaluation', 'Frame', 'Frames', 'Info', 'LightField', 'PictureQuality',
              'PointQuality', 'Quality', 'Turntable', 'annotate', 'encode', 'eval', 'export', 'frames', 'html', 'info', 'pack',
              'read', 'settings', 'truncate'):
    globals()[_name].__module__ = __name__
del _name
