# SPDX-License-Identifier: Apache-2.0
"""A room that one stands in. Metres; z is up."""
import random

import bpy

from bowl_and_wheel import Nodes
from buildings import box, column, stained, stone


def living_room():
    draw = random.Random(7)
    plaster = stained("plaster", 1.1, [(0.3, (0.62, 0.58, 0.5)), (0.7, (0.75, 0.72, 0.66))])
    planks = stone("planks", 1.3, (0.40, 0.25, 0.13), (0.30, 0.18, 0.09))
    carpet = stained("carpet", 14, [(0.35, (0.35, 0.05, 0.06)), (0.5, (0.08, 0.08, 0.2)), (0.65, (0.55, 0.45, 0.3))])
    wood = stained("wood", 6, [(0.3, (0.16, 0.08, 0.03)), (0.7, (0.32, 0.18, 0.08))])
    cloth = stained("cloth", 40, [(0.4, (0.1, 0.2, 0.28)), (0.6, (0.2, 0.33, 0.4))])
    ceiling = stained("ceiling", 0.7, [(0.3, (0.8, 0.8, 0.78)), (0.7, (0.86, 0.86, 0.84))])
    gloss = Nodes("gloss", roughness=0.15, colour=(0.5, 0.08, 0.05)).material
    metal = Nodes("metal", roughness=0.12, metallic=1.0, colour=(0.8, 0.7, 0.5)).material
    light = Nodes("light", roughness=1, colour=(1, 1, 1))
    emission = light.tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (0.8, 0.9, 1, 1), 4
    light.tree.links.new(emission.outputs["Emission"], light.tree.nodes["Material Output"].inputs["Surface"])
    box((-3, 3), (-2.5, 2.5), (-0.1, 0), planks)
    box((-3, 3), (-2.5, 2.5), (2.6, 2.7), ceiling)
    for x, y in (((-3.1, -3), (-2.5, 2.5)), ((3, 3.1), (-2.5, 2.5)), ((-3, 3), (-2.6, -2.5)), ((-3, 3), (2.5, 2.6))):
        box(x, y, (0, 2.6), plaster)
    box((-1.4, 1.0), (-1.1, 0.9), (0, 0.015), carpet)
    box((-0.9, 0.5), (-0.5, 0.3), (0.42, 0.46), wood)  # a low table
    for x in (-0.85, 0.4):
        for y in (-0.45, 0.2):
            box((x, x + 0.06), (y, y + 0.06), (0, 0.42), wood)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.13, location=(-0.1, -0.1, 0.59), segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(metal)
    column(-0.6, 0.05, (0.46, 0.72), 0.07, gloss, top=0.1)
    box((-2.9, -2.0), (-1.2, 1.2), (0.05, 0.42), cloth)  # a sofa
    box((-3.0, -2.75), (-1.2, 1.2), (0.42, 0.85), cloth)
    box((1.2, 2.9), (2.15, 2.5), (0, 0.03), wood)  # shelves and books
    for z in (0.0, 0.45, 0.9, 1.35, 1.8):
        box((1.2, 2.9), (2.15, 2.5), (z, z + 0.03), wood)
        x = 1.22
        while z < 1.8 and x < 2.8:
            wide, high = draw.uniform(0.03, 0.07), draw.uniform(0.2, 0.38)
            colour = tuple(draw.uniform(0.03, 0.6) for _ in range(3))
            box((x, x + wide), (2.2, 2.45), (z + 0.03, z + 0.03 + high), Nodes("book", roughness=0.6, colour=colour).material)
            x += wide + 0.004
    box((2.97, 3.0), (-1.0, 0.8), (0.9, 2.1), light.material)  # a window
    for y in (-1.06, -0.13, 0.8):
        box((2.93, 3.0), (y, y + 0.06), (0.85, 2.15), wood)
    for k, (x, z) in enumerate(((-1.6, 1.5), (0.0, 1.45), (1.4, 1.6))):  # pictures
        box((x - 0.4, x + 0.4), (-2.5, -2.46), (z - 0.3, z + 0.3), wood)
        stops = [(0.3, tuple(draw.uniform(0, 0.7) for _ in range(3))), (0.5, tuple(draw.uniform(0, 0.7) for _ in range(3))),
                 (0.7, tuple(draw.uniform(0, 0.7) for _ in range(3)))]
        box((x - 0.35, x + 0.35), (-2.46, -2.45), (z - 0.25, z + 0.25), stained(f"picture{k}", 5 + 3 * k, stops))
    column(2.4, -2.0, (0, 1.5), 0.03, metal)
    column(2.4, -2.0, (1.4, 1.8), 0.25, plaster, top=0.15)
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "AREA"))
    lamp.data.energy, lamp.data.size, lamp.location = 60, 1.2, (0, 0, 2.55)
    bpy.context.collection.objects.link(lamp)
    return []
