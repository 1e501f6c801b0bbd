# SPDX-License-Identifier: Apache-2.0
"""Draws a capture of thin, hollow and reflecting things with Blender.

    blender -b --factory-startup -P tools/captures/draw_capture.py -- OUT [--size N] [--cameras N] ...

A round board with a matte procedural pattern carries a wheel with spokes, a lattice tower of straight rods,
a bowl that is glazed inside, and a ball that mirrors them. OUT receives cameras.json, images/, points.ply
(exact points of the surface with normals, those that some camera sees) and sparse_points.ply (what a program
for structure from motion would find: few, noisy, without normals, some of them wrong).
"""
import argparse
import json
import math
import pathlib
import sys
import time

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # Blender does not
import bowl_and_wheel  # noqa: E402
import surface  # noqa: E402
from capture_files import RADIUS, centre_of, png, run, write_whole  # noqa: E402

FOCAL_WIDTHS = 2.375    # focal length over the width of a picture
ELEVATIONS = (-25, -8, 8, 24, 40, 56, 72)  # degrees, one ring of cameras each
BACKGROUND = 128        # display value behind the object
HELD_OUT_EACH = 4       # every fourth camera


def options():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="draw_capture.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--size", type=int, default=320, help="pixels a side")
    parser.add_argument("--cameras", type=int, default=100)
    parser.add_argument("--samples", type=int, default=64, help="of a pixel")
    parser.add_argument("--points", type=int, default=100_000, help="about so many in points.ply")
    parser.add_argument("--denoise", action="store_true", help="by OpenImageDenoise, where this Blender has it")
    parser.add_argument("--threads", type=int, default=0, help="0: all processors")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="do not draw pictures again that are there")
    given = parser.parse_args(words)
    for name, low, high in (("size", 16, 4096), ("cameras", 8, 10_000), ("samples", 1, 65_536), ("points", 100, 10_000_000),
                            ("threads", 0, 1024), ("seed", 0, 2**31 - 1)):
        if not low <= getattr(given, name) <= high:
            parser.error(f"--{name}: a number {low} to {high} is expected")
    return given


# Cameras.

def ring_sizes(count):
    """Cameras of every ring: by its length, count in all."""
    shares = np.cos(np.radians(ELEVATIONS))
    return np.diff(np.round(np.concatenate([[0], np.cumsum(shares / shares.sum()) * count])).astype(int))


def camera_rows(count, size):
    """Entries of cameras.json, ring by ring from below."""
    rows, focal = [], FOCAL_WIDTHS * size
    for ring, (elevation, on_ring) in enumerate(zip(ELEVATIONS, ring_sizes(count))):
        for index in range(on_ring):
            azimuth = 2 * math.pi * (index / on_ring + ring * 0.6180339887498949 % 1)
            e = math.radians(elevation)
            outwards = np.array([math.cos(azimuth) * math.cos(e), math.sin(azimuth) * math.cos(e), math.sin(e)])
            right = np.array([-math.sin(azimuth), math.cos(azimuth), 0.0])
            rotation = np.stack([right, np.cross(-outwards, right), -outwards])  # x right, y down, z forward
            rows.append({"image": f"images/{len(rows) + 1:04d}.png", "width": size, "height": size,
                         "K": [[focal, 0, size / 2], [0, focal, size / 2], [0, 0, 1]], "R": rotation.tolist(),
                         "t": [0.0, 0.0, RADIUS], "ring": ring, "index": index})
    return rows


def inputs_of(rows):
    return [row for i, row in enumerate(rows) if i % HELD_OUT_EACH != HELD_OUT_EACH - 1]


def write_cameras(given, rows):
    inputs = [row["image"] for row in inputs_of(rows)]
    denoised = ", denoised" if given.denoise else ""
    write_whole(given.out / "cameras.json", json.dumps(
        {"name": "bowl_and_wheel", "renderer": f"Blender {bpy.app.version_string} Cycles, {given.samples} samples per pixel{denoised}",
         "pixel_centres": "+0.5", "up": "+z", "cameras": rows,
         "splits": {"dense": inputs, "evaluation": [row["image"] for row in rows if row["image"] not in inputs]}}, indent=1).encode())


# Pictures.

def set_up_renderer(given):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = given.size
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode, scene.render.image_settings.color_depth = "RGBA", "16"
    scene.render.threads_mode, scene.render.threads = ("FIXED", given.threads) if given.threads else ("AUTO", 1)
    scene.render.use_persistent_data = True
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling = "CPU", given.samples, False
    cycles.use_denoising = given.denoise
    if given.denoise:
        try:
            cycles.denoiser = "OPENIMAGEDENOISE"
        except TypeError:
            sys.exit("draw_capture: this Blender is built without OpenImageDenoise (Debian's is): leave --denoise out")
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces = 6, 2, 5
    cycles.caustics_reflective = cycles.caustics_refractive = False
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", 36, 36 * FOCAL_WIDTHS
    scene.camera = bpy.data.objects.new("camera", data)
    bpy.context.collection.objects.link(scene.camera)


def draw(row, seed, scratch):
    """Display values [height, width, 3] over the background."""
    scene = bpy.context.scene
    rotation = np.array(row["R"]).T * [1, -1, -1]  # Blender's camera has y up and looks along -z
    scene.camera.matrix_world = Matrix.Translation(centre_of(row)) @ Matrix(rotation.tolist()).to_4x4()
    scene.cycles.seed = seed
    scene.render.filepath = str(scratch)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(scratch))
    image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
    values = np.empty(4 * row["width"] * row["height"], np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    scratch.unlink()
    values = values.reshape(row["height"], row["width"], 4)[::-1]
    over = 255 * values[..., :3] * values[..., 3:] + BACKGROUND * (1 - values[..., 3:])
    return np.clip(np.round(over), 0, 255).astype(np.uint8)


def draw_all(given, rows):
    set_up_renderer(given)
    start = time.monotonic()
    for number, row in enumerate(rows):
        path = given.out / row["image"]
        if given.keep and path.exists():
            continue
        write_whole(path, png(draw(row, given.seed + number, given.out / "images" / "drawing.png")))
        print(f"draw_capture: {number + 1} of {len(rows)}, {time.monotonic() - start:.0f} s", flush=True)


def main():
    given = options()
    (given.out / "images").mkdir(parents=True, exist_ok=True)
    bowl_and_wheel.make_scene()
    rows = camera_rows(given.cameras, given.size)
    write_cameras(given, rows)
    draw_all(given, rows)
    surface.write_points(given, rows, inputs_of(rows))


if __name__ == "__main__":
    run(main)
