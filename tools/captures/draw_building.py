# SPDX-License-Identifier: Apache-2.0
"""Draws a capture of a building before a sky, or of a room, as somebody with a camera would take it, with Blender.

    blender -b --factory-startup -P tools/captures/draw_building.py -- OUT castle|temple|room [--samples N] ...

castle: 13 photographs along an arc of 60 degrees, 3 of them held out. temple: 26 along 200 degrees, 5 held out. room: 56 from
among the furniture across to the other side, 8 held out. OUT receives
cameras.json, images/, points.ply (a noisy cloud of what two input photographs see, but for what is far away) and
sparse_points.ply (3,500 of them, without normals).
"""
import argparse
import json
import math
import pathlib
import sys
from typing import Callable, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # Blender does not
import buildings  # noqa: E402
import rooms  # noqa: E402
import surface  # noqa: E402
from capture_files import centre_of, run, write_ply, write_whole  # noqa: E402


class Walk(NamedTuple):
    """Cameras about the origin: degrees from .. to; metres, give or take; heights; what camera i looks at; which are held out."""
    count: int
    degrees: tuple
    metres: tuple
    heights: tuple
    target: Callable
    held_out: tuple


def front(i):
    return [0.6 * math.sin(1.1 * i), 0.5, 2.6]


def middle(i):
    return [0.3 * math.sin(1.1 * i), 0.3 * math.cos(1.9 * i), 0.8 + 0.4 * math.sin(0.7 * i)]


SCENES = {
    "castle": (buildings.castle, Walk(13, (-120, -60), (14.5, 0.8), (1.2, 2.2), front, (3, 6, 9))),
    "temple": (buildings.temple, Walk(26, (-190, 10), (13.0, 0.8), (1.6, 2.8), front, (3, 8, 13, 18, 23))),
    "room": (rooms.living_room, Walk(56, (0, 360), (1.6, 0.4), (1.1, 1.7), middle, tuple(range(3, 56, 7)))),
}
SPARSE = 3500
NOISE, DEPTH_NOISE, OUTLIERS, NORMAL_NOISE = 0.5, 1.5, 0.01, 0.15  # pixels across and along the view, a share, of a unit normal


def options():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="draw_building.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("--width", type=int, default=480, help="pixels; the height is two thirds of it")
    parser.add_argument("--samples", type=int, default=24, help="of a pixel")
    parser.add_argument("--points", type=int, default=400_000, help="drawn on all surfaces; cameras see a fifth or so")
    given = parser.parse_args(words)
    for name, low, high in (("width", 24, 8192), ("samples", 1, 65_536), ("points", 1000, 100_000_000)):
        if not low <= getattr(given, name) <= high:
            parser.error(f"--{name}: a number {low} to {high} is expected")
    return given


def camera_rows(given):
    walk = SCENES[given.scene][1]
    (first, last), (low, high) = walk.degrees, walk.heights
    width, height = given.width, given.width * 2 // 3
    rows = []
    for i in range(walk.count):
        angle = math.radians(first + (last - first) * i / (walk.count - 1))
        reach = walk.metres[0] + walk.metres[1] * math.sin(1.7 * i)
        eye = np.array([reach * math.cos(angle), reach * math.sin(angle), (low + high) / 2 + (high - low) / 2 * math.sin(2.3 * i)])
        forward = np.array(walk.target(i)) - eye
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0, 0, 1])
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(forward, right), forward])
        rows.append({"image": f"images/{i + 1:04d}.png", "width": width, "height": height,
                     "K": [[width, 0, width / 2], [0, width, height / 2], [0, 0, 1]], "R": rotation.tolist(), "t": (-rotation @ eye).tolist()})
    return rows


def draw_all(given, rows):
    scene = bpy.context.scene
    scene.render.engine, scene.render.use_persistent_data = "CYCLES", True
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = rows[0]["width"], rows[0]["height"], 100
    scene.render.image_settings.file_format, scene.view_settings.view_transform = "PNG", "Standard"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = "CPU", given.samples, False, 4
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", 36, 36  # focal length: the width
    scene.camera = bpy.data.objects.new("camera", data)
    bpy.context.collection.objects.link(scene.camera)
    for row in rows:
        rotation = np.array(row["R"]).T * [1, -1, -1]  # Blender's camera has y up and looks along -z
        scene.camera.matrix_world = Matrix.Translation(centre_of(row)) @ Matrix(rotation.tolist()).to_4x4()
        scene.render.filepath = str(given.out / row["image"])
        bpy.ops.render.render(write_still=True)


def are_in_picture(row, points):
    x, y, z = np.array(row["R"]) @ points.T + np.array(row["t"])[:, None]
    focal = row["K"][0][0]
    return (z > 0.1) & (abs(focal * x) < z * row["width"] / 2) & (abs(focal * y) < z * row["height"] / 2)


def are_seen_by_two(shapes, points, normals, inputs):
    count = np.zeros(len(points), int)
    for row in inputs:
        eye = centre_of(row)
        for i in np.flatnonzero((count < 2) & are_in_picture(row, points)):
            count[i] += shapes.sees(points[i], normals[i], eye)
    return count == 2


def write_points(given, inputs):
    shapes, random_ = surface.Surface(), np.random.default_rng(1)
    points, normals = shapes.sample(given.points, random_)
    seen = are_seen_by_two(shapes, points, normals, inputs)
    points, normals = points[seen], normals[seen]
    views = points - np.mean([centre_of(row) for row in inputs], axis=0)
    pixels = np.linalg.norm(views, axis=1, keepdims=True) / given.width  # world size of one, about
    views /= np.linalg.norm(views, axis=1, keepdims=True)
    points = points + NOISE * pixels * random_.normal(size=points.shape) + DEPTH_NOISE * pixels * views * random_.normal(size=(len(points), 1))
    wrong = random_.random(len(points)) < OUTLIERS
    points[wrong] += random_.normal(0, 0.5, (wrong.sum(), 3))
    normals = normals + random_.normal(0, NORMAL_NOISE, normals.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    write_ply(given.out / "points.ply", [(("x", "y", "z"), "float", points), (("nx", "ny", "nz"), "float", normals)])
    some = random_.choice(len(points), min(SPARSE, len(points)), replace=False)
    write_ply(given.out / "sparse_points.ply", [(("x", "y", "z"), "float", points[some])])
    print(f"draw_building: {len(points)} points")


def main():
    given = options()
    (given.out / "images").mkdir(parents=True, exist_ok=True)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    make, walk = SCENES[given.scene]
    far = make()
    rows, held_out = camera_rows(given), walk.held_out
    inputs = [row for i, row in enumerate(rows) if i not in held_out]
    write_whole(given.out / "cameras.json", json.dumps(
        {"name": given.scene, "pixel_centres": "+0.5", "up": "+z", "cameras": rows,
         "splits": {"dense": [row["image"] for row in inputs], "evaluation": [rows[i]["image"] for i in held_out]}}, indent=1).encode())
    draw_all(given, rows)
    for thing in far:
        bpy.data.objects.remove(thing)
    write_points(given, inputs)


if __name__ == "__main__":
    run(main)
