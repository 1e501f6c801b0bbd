# SPDX-License-Identifier: Apache-2.0
"""Points of the meshes of a scene: exact ones for points.ply, and what structure from motion would find of them."""
import math
import random

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from capture_files import RADIUS, centre_of, write_ply

DARTS = 0.53    # points that stay over an area of the square of their least distance, measured on this scene
LIFT = 1e-4     # of the start of a ray above its surface
SPARSE_SHARE = 0.03    # points of sparse_points.ply over those of points.ply
SPARSE_PIXELS = 0.5    # standard deviation along each axis
SPARSE_OUTLIERS = 0.02
SPARSE_VIEWS = 3       # input cameras that see a point at least


class Surface:
    """Triangles of all meshes as they are rendered."""

    def __init__(self):
        corners, normals = [], []
        graph = bpy.context.evaluated_depsgraph_get()
        for thing in bpy.context.scene.objects:
            if thing.type != "MESH":
                continue
            evaluated = thing.evaluated_get(graph)
            mesh = evaluated.to_mesh()
            if hasattr(mesh, "calc_normals_split"):  # until Blender 4.0
                mesh.calc_normals_split()
            mesh.calc_loop_triangles()
            place, turn = np.array(thing.matrix_world), np.array(thing.matrix_world.to_3x3().inverted().transposed())
            vertices = array_of(mesh.vertices, "co", 3) @ place[:3, :3].T + place[:3, 3]
            corner_normals = array_of(mesh.loops, "normal", 3) @ turn.T
            corners.append(vertices[array_of(mesh.loop_triangles, "vertices", 3, np.int32)])
            normals.append(corner_normals[array_of(mesh.loop_triangles, "loops", 3, np.int32)])
            evaluated.to_mesh_clear()
        self.corners, self.normals = np.concatenate(corners), np.concatenate(normals)
        edges = self.corners[:, 1:] - self.corners[:, :1]
        self.areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
        flat = self.corners.reshape(-1, 3).tolist()
        self.tree = BVHTree.FromPolygons(flat, np.arange(len(flat)).reshape(-1, 3).tolist(), all_triangles=True)

    def sample(self, count, random_):
        """Positions and unit normals [count, 3], area-uniform."""
        triangles = random_.choice(len(self.areas), count, p=self.areas / self.areas.sum())
        root, v = np.sqrt(random_.random(count)), random_.random(count)
        weights = np.stack([1 - root, root * (1 - v), root * v], 1)[..., None]
        normals = (weights * self.normals[triangles]).sum(1)
        return (weights * self.corners[triangles]).sum(1), normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def sees(self, point, normal, eye):
        to_eye = Vector(eye - point)
        if to_eye.dot(normal) <= 0:
            return False
        return self.tree.ray_cast(Vector(point + LIFT * normal), to_eye.normalized(), to_eye.length)[0] is None


def array_of(collection, name, width, kind=np.float32):
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values.reshape(-1, width).astype(np.float64 if kind == np.float32 else kind)


def spread(points, normals, distance):
    """Indices of points of which no two on one side of a surface are nearer than a distance: the first come stay."""
    cells, kept = {}, []
    keys = np.floor(points / distance).astype(int).tolist()
    around = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    places, sides = points.tolist(), normals.tolist()
    for i, (key, (px, py, pz), (nx, ny, nz)) in enumerate(zip(keys, places, sides)):
        free = True
        for dx, dy, dz in around:
            for j in cells.get((key[0] + dx, key[1] + dy, key[2] + dz), ()):
                qx, qy, qz = places[j]
                mx, my, mz = sides[j]
                if (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2 < distance ** 2 and nx * mx + ny * my + nz * mz > 0:
                    free = False
                    break
            if not free:
                break
        if free:
            cells.setdefault(tuple(key), []).append(i)
            kept.append(i)
    return np.array(kept)


def surface_points(surface, count, eyes, seed):
    """Positions and normals of about `count` points that some camera sees, evenly spread."""
    random_ = np.random.default_rng(seed)
    order = random.Random(seed)
    points, normals = surface.sample(6 * count, random_)

    def seen(i):
        return any(surface.sees(points[i], normals[i], eye) for eye in order.sample(eyes, len(eyes)))

    trial = range(0, len(points), max(len(points) // 2000, 1))
    visible = sum(map(seen, trial)) / len(trial)
    kept = spread(points, normals, math.sqrt(DARTS * visible * surface.areas.sum() / count))
    kept = np.array([i for i in kept if seen(i)])
    return points[kept], normals[kept]


def sparse_points(surface, points, normals, inputs, out, seed):
    """Positions and colours [n, 3] as a program for structure from motion would find them."""
    random_ = np.random.default_rng(seed + 1)
    count = max(int(SPARSE_SHARE * len(points)), 8)
    photographs = {row["image"]: read_picture(out / row["image"]) for row in inputs}
    found, colours = [], []
    for i in random_.permutation(len(points)):
        if len(found) == count:
            break
        seen = [row for row in inputs if surface.sees(points[i], normals[i], centre_of(row))]
        if len(seen) >= SPARSE_VIEWS:
            colours.append(np.median([colour_at(photographs[row["image"]], row, points[i]) for row in seen], axis=0))
            found.append(points[i])
    found, colours = np.array(found), np.array(colours)
    pixel = RADIUS / inputs[0]["K"][0][0]
    found += random_.normal(0, SPARSE_PIXELS * pixel, found.shape)
    wrong = random_.permutation(len(found))[:round(SPARSE_OUTLIERS * len(found))]
    found[wrong] = random_.uniform(1.2 * points.min(0), 1.2 * points.max(0), (len(wrong), 3))
    return found, np.round(colours).astype(np.uint8)


def read_picture(path):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(values)
    picture = 255 * values.reshape(image.size[1], image.size[0], 4)[::-1, :, :3]
    bpy.data.images.remove(image)
    return picture


def colour_at(picture, row, point):
    x, y, z = np.array(row["R"]) @ point + np.array(row["t"])
    focal, height, width = row["K"][0][0], *picture.shape[:2]
    u, v = int(row["K"][0][2] + focal * x / z), int(row["K"][1][2] + focal * y / z)
    return picture[min(max(v, 0), height - 1), min(max(u, 0), width - 1)]


def write_points(given, rows, inputs):
    """points.ply, and sparse_points.ply from the photographs of the inputs."""
    surface = Surface()
    points, normals = surface_points(surface, given.points, [centre_of(row) for row in rows], given.seed)
    write_ply(given.out / "points.ply", [(("x", "y", "z"), "float", points), (("nx", "ny", "nz"), "float", normals)])
    found, colours = sparse_points(surface, points, normals, inputs, given.out, given.seed)
    write_ply(given.out / "sparse_points.ply", [(("x", "y", "z"), "float", found), (("red", "green", "blue"), "uchar", colours)])
    print(f"draw_capture: {len(points)} points, {len(found)} sparse points")
