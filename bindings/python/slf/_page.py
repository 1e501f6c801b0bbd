# SPDX-License-Identifier: Apache-2.0
"""One web page with a file, the decoder and a viewer in it, as `slf html` makes it."""
from __future__ import annotations

import base64
import html as markup
import json
import os
import pathlib
import re
from typing import Any, Dict, Optional, Tuple

import numpy as np

from . import _slf
from ._arguments import ELEVATION, FOV, MOST_METRES, colour, number, pixels
from ._errors import make
from ._field import LightField, check_camera, read
from ._notes import Notes, notes_text
from ._sources import bytes_of
from ._types import UP, Camera, Info, Source

_PIXELS, _QUALITY = 480, 75  #: of the poster
_PAPER, _SLATE = (0xf3, 0xf1, 0xec), (0x19, 0x1a, 0x1d)  #: the viewer's own backgrounds by day and night


def html(source: Source, *, title: str = '', camera: Optional[Camera] = None,
         azimuth: Optional[float] = None, elevation: Optional[float] = None,
         fov: Optional[float] = None, autorotate: float = 0, speed: float = 1, loop: bool = True,
         paused: bool = False, background: Optional[Tuple[int, int, int]] = None,
         poster: bool = True, notes: Optional[Notes] = None, metres_per_unit: float = 0, threads: int = 0, max_memory: int = 0) -> str:
    """A page that asks nobody for anything: write it to a file that ends in .html.

    title: default is the file's own, else its name. The first view is the camera, else azimuth,
    elevation and fov of an orbit (degrees; 30, 20, 30), else the file's own view, else that orbit.
    autorotate: degrees a second, -90 to 90. speed (1/16 to 16), loop, paused: of a light field that
    moves. background: R, G, B; None is light by day and dark by night. poster: a picture that shows
    until the file is decoded. notes: points with text and guided tours (docs/notes.md), a file or a
    dict; None is the file's own. metres_per_unit: of the world, by which the page measures; 0 is the
    file's own.
    Raises what read() raises; UnsupportedError of a package without the viewer (web/build.sh).
    """
    template = pathlib.Path(__file__).with_name('one_file.html')
    if not template.exists():
        raise make('SLF_UNSUPPORTED', 'this package was built without the viewer page web/dist/one_file.html',
                   '', '', 0)
    orbit = _orbit(azimuth, elevation, fov)
    chosen = camera is not None or (azimuth, elevation, fov) != (None, None, None)
    autorotate, speed = number(autorotate, 'autorotate', -90, 90), number(speed, 'speed', 1 / 16, 16)
    metres_per_unit = number(metres_per_unit, 'metres_per_unit', 0, MOST_METRES)
    if camera is not None:
        check_camera(camera)
    back = None if background is None else colour(background, 'background')
    data = bytes_of(source)
    field = read(data, threads=threads, max_memory=max_memory)
    header = field.header
    if not chosen:
        own = _slf.named_view(list(header.metadata), UP.index(header.up), _PIXELS, _PIXELS)
        camera = None if own is None else Camera(**own)
    name = title or _title(header, source)
    options: Dict[str, Any] = {'title': name, **orbit}
    if back:
        options['background'] = '%02x%02x%02x' % back
    if autorotate:
        options['autorotate'] = autorotate
    if camera is not None:
        options['view'] = _view(camera)
    options.update({key: value for key, value, usual in
                    [('speed', speed, 1), ('loop', bool(loop), True), ('paused', bool(paused), False)] if value != usual})
    if metres_per_unit:
        options['metres'] = metres_per_unit
    if notes is not None:
        options['notes'] = json.loads(notes_text(notes))
    pictures = _posters(field, camera, orbit, back) if poster else ('', '')
    night = f'<source media="(prefers-color-scheme: dark)" srcset="{pictures[1]}">' if pictures[1] else ''
    values = {'title': markup.escape(name), 'poster': pictures[0] or 'data:,', 'night': night,
              'options': json.dumps(options).replace('<', '\\u003c'),
              'file': base64.b64encode(data).decode()}
    return re.sub(r'{{slf:(\w+)}}', lambda found: values.get(found[1], ''), template.read_text(encoding='utf-8'))


def _orbit(azimuth: Optional[float], elevation: Optional[float], fov: Optional[float]) -> Dict[str, float]:
    return {'azimuth': number(30 if azimuth is None else azimuth, 'azimuth', -360, 360),
            'elevation': number(20 if elevation is None else elevation, 'elevation', *ELEVATION),
            'fov': number(30 if fov is None else fov, 'fov', *FOV)}


def _title(header: Info, source: Source) -> str:
    for wanted in ('title', 'source'):
        for key, value in header.metadata:
            if key == wanted and value:
                return value
    return pathlib.PurePath(os.fspath(source)).stem if isinstance(source, (str, os.PathLike)) else 'Surface light field'


def _view(camera: Camera) -> Dict[str, Any]:
    """The camera as the viewer reads it: rows right, down, forward, and where the eye is."""
    k, r, t = (np.asarray(m, float) for m in (camera.K, camera.R, camera.t))
    width, height = pixels((camera.width, camera.height))
    return {'width': width, 'height': height, 'fx': k[0, 0], 'fy': k[1, 1], 'cx': k[0, 2], 'cy': k[1, 2],
            'rotation': r.reshape(-1).tolist(), 'eye': (-r.T @ t).tolist()}


def _square(camera: Camera) -> Camera:
    """The part of the camera's picture that a square poster shows, which is where the viewer starts."""
    side = min(camera.width, camera.height)
    k = np.array(camera.K, float)
    k[0, 2] -= (camera.width - side) / 2
    k[1, 2] -= (camera.height - side) / 2
    cut = Camera(side, side, k, camera.R, camera.t, camera.distortion, camera.name)
    return cut.resized((_PIXELS, _PIXELS))


def _posters(field: LightField, camera: Optional[Camera], orbit: Dict[str, float],
             background: Optional[Tuple[int, int, int]]) -> Tuple[str, str]:
    """Addresses of the pictures by day and by night; the second is empty where it is the first."""
    view = _square(camera) if camera is not None else field.orbit(
        orbit['azimuth'] / 360, orbit['elevation'], (_PIXELS, _PIXELS), orbit['fov'])
    drawn = [field.render(view, background=back) for back in ([background] if background else [_PAPER, _SLATE])]
    pictures = ['data:image/jpeg;base64,' + base64.b64encode(_slf.jpeg(picture, _QUALITY)).decode()
                for picture in drawn]
    return pictures[0], pictures[1] if len(pictures) > 1 else ''
