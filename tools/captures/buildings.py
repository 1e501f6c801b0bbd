# SPDX-License-Identifier: Apache-2.0
"""Scenes with a sky: the front of a castle, and a temple that one walks around. Metres; z is up."""
import math

import bpy

from bowl_and_wheel import Nodes


# Materials.

def stone(name, scale, light, dark):
    """Bricks with stains."""
    nodes = Nodes(name, roughness=0.9)
    bricks, stains = nodes.pattern("Brick", Scale=scale), nodes.pattern("Noise", Scale=3.0, Detail=6.0)
    for socket, colour in (("Color1", light), ("Color2", dark), ("Mortar", (0.6, 0.58, 0.5))):
        bricks.inputs[socket].default_value = (*colour, 1)
    both = nodes.tree.nodes.new("ShaderNodeMixRGB")
    both.blend_type, both.inputs["Fac"].default_value = "MULTIPLY", 1
    nodes.tree.links.new(bricks.outputs["Color"], both.inputs["Color1"])
    nodes.tree.links.new(nodes.ramp(stains.outputs["Fac"], [(0.3, (0.5, 0.5, 0.5)), (0.7, (1, 1, 1))]), both.inputs["Color2"])
    return nodes.painted(both.outputs["Color"])


def stained(name, scale, stops):
    nodes = Nodes(name, roughness=0.95)
    return nodes.painted(nodes.ramp(nodes.pattern("Noise", Scale=scale, Detail=8.0).outputs["Fac"], stops))


class Materials:
    def __init__(self):
        self.wall = stone("wall", 1.2, (0.45, 0.36, 0.25), (0.35, 0.30, 0.24))
        self.tower = stone("tower", 1.6, (0.5, 0.42, 0.33), (0.42, 0.38, 0.33))
        self.roof = stained("roof", 9, [(0.3, (0.25, 0.08, 0.05)), (0.7, (0.45, 0.17, 0.10))])
        self.ground = stained("ground", 1.3, [(0.3, (0.22, 0.20, 0.16)), (0.5, (0.35, 0.32, 0.26)), (0.7, (0.5, 0.46, 0.38))])
        self.hill = stained("hill", 0.15, [(0.3, (0.05, 0.12, 0.04)), (0.7, (0.2, 0.28, 0.1))])
        self.wood = stained("wood", 6, [(0.3, (0.1, 0.05, 0.02)), (0.7, (0.22, 0.12, 0.05))])
        self.glass = Nodes("glass", roughness=0.05, metallic=0.6, colour=(0.1, 0.12, 0.15)).material


# Shapes.

def placed(material):
    thing = bpy.context.object
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    thing.data.materials.append(material)
    return thing


def box(x, y, z, material):
    """x, y, z: (from, to)"""
    bpy.ops.mesh.primitive_cube_add(size=1, location=[(low + high) / 2 for low, high in (x, y, z)])
    bpy.context.object.scale = [high - low for low, high in (x, y, z)]
    return placed(material)


def column(x, y, z, radius, material, top=None, corners=48, turn=0.0):
    """z: (from, to); top: its radius there, else the same"""
    bpy.ops.mesh.primitive_cone_add(vertices=corners, radius1=radius, radius2=radius if top is None else top, depth=z[1] - z[0],
                                    location=(x, y, (z[0] + z[1]) / 2), rotation=(0, 0, turn))
    return placed(material)


# Scenes. Each leaves what cameras see of the building, and returns what lies too far away for points.

def surroundings(materials, sky):
    box((-14, 14), (-16, 6), (-0.2, 0), materials.ground)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.5, (math.radians(50), 0, math.radians(-35))
    bpy.context.collection.objects.link(sun)
    world = bpy.context.scene.world or bpy.data.worlds.new("world")
    bpy.context.scene.world, world.use_nodes = world, True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    place, clouds, ramp = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "TexNoise", "ValToRGB"))
    clouds.inputs["Scale"].default_value, clouds.inputs["Detail"].default_value = 2.5, 6
    for element, (at, colour) in zip(ramp.color_ramp.elements, ((0.4, sky), (0.65, (0.9, 0.92, 0.95)))):
        element.position, element.color = at, (*colour, 1)
    links.new(place.outputs["Generated"], clouds.inputs["Vector"])
    links.new(clouds.outputs["Fac"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Background"].inputs["Color"])
    return [box((-120, 120), (60, 62), (-10, 14), materials.hill), box((-120, 120), (-40, 62), (-0.6, -0.5), materials.hill)]


def castle():
    m = Materials()
    box((-6, 6), (0, 1), (0, 5), m.wall)
    for k in range(12):
        box((-6 + k, -5.5 + k), (0, 1), (5, 5.5), m.wall)
    for x, y, height, radius in ((-5.5, 0.3, 7, 1.3), (4.5, -0.5, 6.5, 1.1)):
        column(x, y, (0, height), radius, m.tower)
        column(x, y, (height, height + 2 * radius), radius + 0.3, m.roof, top=0.02)
    box((-1.3, 1.3), (-1.0, 0.2), (0, 3.6), m.tower)
    box((-0.7, 0.7), (-1.05, -0.95), (0, 2.4), m.wood)
    box((-1.5, 1.5), (-1.2, 0.3), (3.6, 3.9), m.roof)
    for x in (-3.8, -2.6, 2.2, 3.2):
        for z in (1.2, 3.2):
            box((x - 0.3, x + 0.3), (-0.06, 0.05), (z, z + 1), m.glass)
            box((x - 0.4, x + 0.4), (-0.15, 0.05), (z - 0.15, z), m.tower)
    box((-2, -1.6), (-4, -3.6), (0, 1.1), m.tower)
    box((2.5, 3.7), (-4.2, -3.2), (0, 0.8), m.wood)
    column(0.3, -5, (0, 0.9), 0.6, m.tower)
    return surroundings(m, sky=(0.25, 0.45, 0.8))


def temple():
    m = Materials()
    box((-4.5, 4.5), (-3, 3), (0, 0.3), m.tower)
    box((-4, 4), (-2.6, 2.6), (0.3, 0.6), m.wall)
    around = [(-3.6 + 1.2 * k, y) for k in range(7) for y in (-2.2, 2.2)] + [(x, y) for x in (-3.6, 3.6) for y in (-1.1, 0, 1.1)]
    for x, y in around:
        column(x, y, (0.6, 3.8), 0.25, m.tower)
    box((-4.1, 4.1), (-2.6, 2.6), (3.8, 4.3), m.wall)
    box((-2, 2), (-1, 1), (0.6, 3.4), m.wood)
    column(0, 0, (4.3, 5.9), 5.4, m.roof, top=0.2, corners=4, turn=math.pi / 4)
    column(6.5, -3, (0, 1.2), 0.9, m.tower)
    column(6.5, -3, (1.2, 3.0), 0.1, m.glass)
    box((-7.5, -6.2), (-3, -2.4), (0, 0.9), m.wood)
    return surroundings(m, sky=(0.35, 0.4, 0.6))
