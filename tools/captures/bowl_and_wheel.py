# SPDX-License-Identifier: Apache-2.0
"""The scene: a board with a wheel, a lattice tower, a bowl and a mirroring ball, within 1 of the origin."""
import math

import bpy
from mathutils import Matrix, Vector

SMOOTH_DEGREES = 40  # edges that are flatter are shaded as round
BOARD_TOP = -0.40


# Materials: procedural, of coordinates of the object.

class Nodes:
    """The node tree of a new material with one principled shader."""

    def __init__(self, name, roughness, metallic=0.0, colour=(0.8, 0.8, 0.8)):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]
        self.shader.inputs["Base Color"].default_value = (*colour, 1)
        self.shader.inputs["Roughness"].default_value = roughness
        self.shader.inputs["Metallic"].default_value = metallic

    def pattern(self, kind, **inputs):
        """A texture node; a name that is no input of it is a property."""
        node = self.tree.nodes.new(f"ShaderNodeTex{kind}")
        place = self.tree.nodes.new("ShaderNodeTexCoord")
        self.tree.links.new(place.outputs["Object"], node.inputs["Vector"])
        for name, value in inputs.items():
            if name in node.inputs:
                node.inputs[name].default_value = value
            else:
                setattr(node, name, value)
        return node

    def ramp(self, value, stops):
        """Colours by a value 0 .. 1: [(place, (r, g, b))]."""
        node = self.tree.nodes.new("ShaderNodeValToRGB")
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (place, colour) in zip(elements, stops):
            element.position, element.color = place, (*colour, 1)
        self.tree.links.new(value, node.inputs["Fac"])
        return node.outputs["Color"]

    def mix(self, share, a, b):
        node = self.tree.nodes.new("ShaderNodeMixRGB")
        for value, to in ((share, "Fac"), (a, "Color1"), (b, "Color2")):
            self.tree.links.new(value, node.inputs[to])
        return node.outputs["Color"]

    def painted(self, colour):
        self.tree.links.new(colour, self.shader.inputs["Base Color"])
        return self.material


def board_paint():
    nodes = Nodes("board", roughness=0.95)
    cells = nodes.pattern("Voronoi", Scale=7.0)
    grain = nodes.pattern("Noise", Scale=22.0, Detail=4.0)
    squares = nodes.pattern("Checker", Scale=6.0)
    light = nodes.ramp(cells.outputs["Distance"], [(0.0, (0.80, 0.62, 0.30)), (0.35, (0.55, 0.30, 0.12)), (0.8, (0.20, 0.10, 0.05))])
    dark = nodes.ramp(grain.outputs["Fac"], [(0.35, (0.08, 0.20, 0.16)), (0.65, (0.45, 0.60, 0.42))])
    return nodes.painted(nodes.mix(squares.outputs["Fac"], light, dark))


def clay():
    nodes = Nodes("clay", roughness=0.8)
    bands = nodes.pattern("Wave", Scale=4.0, Distortion=5.0, Detail=2.0, bands_direction="Z")
    return nodes.painted(nodes.ramp(bands.outputs["Fac"], [(0.2, (0.45, 0.14, 0.06)), (0.8, (0.75, 0.42, 0.24))]))


def glaze():
    nodes = Nodes("glaze", roughness=0.15)
    spots = nodes.pattern("Voronoi", Scale=12.0)
    return nodes.painted(nodes.ramp(spots.outputs["Distance"], [(0.1, (0.75, 0.80, 0.85)), (0.3, (0.05, 0.20, 0.50))]))


def stripes():
    nodes = Nodes("stripes", roughness=0.6)
    bands = nodes.pattern("Wave", Scale=2.5, bands_direction="Z")
    return nodes.painted(nodes.ramp(bands.outputs["Fac"], [(0.48, (0.70, 0.05, 0.04)), (0.52, (0.80, 0.80, 0.78))]))


def plain(name, roughness, metallic, colour):
    return Nodes(name, roughness, metallic, colour).material


# Shapes: closed meshes whose faces look outwards.

def add(name, vertices, faces, materials, material_of=None):
    """An object of the scene. material_of: index of the material of every face."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], faces)
    for material in materials:
        mesh.materials.append(material)
    if material_of:
        mesh.polygons.foreach_set("material_index", material_of)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(SMOOTH_DEGREES)
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def revolved(profile, sides):
    """Vertices, faces and the segment of each face, of a profile [(r, z)] turned about z. It runs with the solid on
    its left: up along the outside. Ends on the axis; a closed profile ends where it began."""
    vertices, faces, segments, rings = [], [], [], []
    closed = profile[0] == profile[-1]
    for r, z in profile[:-1] if closed else profile:
        first = len(vertices)
        if r == 0:
            vertices.append((0, 0, z))
            rings.append([first] * sides)
        else:
            vertices += [(r * math.cos(2 * math.pi * k / sides), r * math.sin(2 * math.pi * k / sides), z) for k in range(sides)]
            rings.append([first + k for k in range(sides)])
    if closed:
        rings.append(rings[0])
    for segment, (low, high) in enumerate(zip(rings, rings[1:])):
        for k in range(sides):
            n = (k + 1) % sides
            corners = [low[k], low[n], high[n], high[k]]
            face = [c for i, c in enumerate(corners) if c != corners[i - 1]]
            if len(face) > 2:
                faces.append(face)
                segments.append(segment)
    return vertices, faces, segments


def placed(thing, at, turn=(0, 0, 0)):
    thing.matrix_world = Matrix.Translation(at) @ Matrix.Rotation(turn[2], 4, "Z") @ Matrix.Rotation(turn[1], 4, "Y") @ \
        Matrix.Rotation(turn[0], 4, "X")
    return thing


def torus(name, ring, tube, material, sides=96, round_=16):
    circle = [(ring + tube * math.cos(2 * math.pi * k / round_), tube * math.sin(2 * math.pi * k / round_)) for k in range(round_)]
    vertices, faces, _ = revolved(circle + circle[:1], sides)
    return add(name, vertices, faces, [material])


def ball(name, radius, material, sides=96):
    arc = [(radius * math.sin(math.pi * k / 48), -radius * math.cos(math.pi * k / 48)) for k in range(1, 48)]
    vertices, faces, _ = revolved([(0, -radius), *arc, (0, radius)], sides)
    return add(name, vertices, faces, [material])


def rods(name, ends, radius, material, sides=12):
    """One object of cylinders between pairs of points."""
    vertices, faces = [], []
    for a, b in ends:
        a, b = Vector(a), Vector(b)
        own, own_faces, _ = revolved([(0, 0), (radius, 0), (radius, (b - a).length), (0, (b - a).length)], sides)
        turn = Vector((0, 0, 1)).rotation_difference(b - a).to_matrix()
        faces += [[i + len(vertices) for i in face] for face in own_faces]
        vertices += [a + turn @ Vector(v) for v in own]
    return add(name, vertices, faces, [material])


def on_circle(radius, turn, z=0.0):
    return (radius * math.cos(2 * math.pi * turn), radius * math.sin(2 * math.pi * turn), z)


def make_board():
    profile = [(0, -0.12), (0.83, -0.12), (0.85, -0.10), (0.85, -0.02), (0.83, 0), (0, 0)]
    vertices, faces, _ = revolved(profile, 128)
    placed(add("board", vertices, faces, [board_paint()]), (0, 0, BOARD_TOP))


def make_bowl():
    """A shell with its foot; what is inside the rim is glazed."""
    steps = 16
    arc = [math.radians(12 + 76 * k / steps) for k in range(steps + 1)]
    outside = [(0.36 * math.sin(a), 0.40 - 0.36 * math.cos(a)) for a in arc]
    inside = [(0.325 * math.sin(a), 0.40 - 0.325 * math.cos(a)) for a in reversed(arc)]
    foot = [(0, 0.03), (0.11, 0.03), (0.11, 0.0), (0.14, 0.0), (0.15, 0.06)]
    profile = foot + outside[2:] + inside + [(0, inside[-1][1])]
    vertices, faces, segments = revolved(profile, 96)
    glazed = len(foot) + len(outside[2:]) - 1
    bowl = add("bowl", vertices, faces, [clay(), glaze()], [int(s > glazed) for s in segments])
    placed(bowl, (-0.30, -0.34, BOARD_TOP))
    placed(ball("bead", 0.07, plain("bead", 0.4, 0, (0.85, 0.55, 0.02)), 48), (-0.24, -0.38, BOARD_TOP + 0.155))


def make_ball():
    placed(ball("mirror", 0.25, plain("mirror", 0.06, 1, (0.92, 0.92, 0.90))), (0.36, -0.26, BOARD_TOP + 0.248))


def make_wheel():
    ring, tube, spokes = 0.40, 0.026, 16
    chrome, steel = plain("chrome", 0.2, 1, (0.85, 0.65, 0.30)), plain("steel", 0.35, 1, (0.60, 0.62, 0.65))
    at, turn = (-0.22, 0.40, BOARD_TOP + ring + tube - 0.004), (math.radians(90), 0, math.radians(18))
    placed(torus("rim", ring, tube, chrome, 128, 24), at, turn)
    hub = revolved([(0, -0.06), (0.045, -0.06), (0.045, 0.06), (0, 0.06)], 48)
    placed(add("hub", hub[0], hub[1], [chrome]), at, turn)
    ends = [(on_circle(0.04, k / spokes + (0.18 if k % 4 < 2 else -0.18), 0.04 if k % 2 else -0.04), on_circle(ring, k / spokes))
            for k in range(spokes)]
    placed(rods("spokes", ends, 0.006, steel), at, turn)


def make_tower():
    count, low, high, height = 10, 0.19, 0.15, 0.80
    ends = [(on_circle(low, k / count), on_circle(high, k / count + twist, height)) for k in range(count) for twist in (0.3, -0.3)]
    at, paint = (0.44, 0.34, BOARD_TOP), stripes()
    placed(rods("lattice", ends, 0.009, paint), at)
    for name, ring, z in (("foot", low, 0.008), ("top", high, height)):
        placed(torus(name, ring, 0.013, paint), (at[0], at[1], at[2] + z))


def make_lights():
    """Area lights that cameras do not see but mirrors do, in a room that is lighter above."""
    for number, (azimuth, elevation, size, power) in enumerate(((20, 50, 1.9, 210), (115, 30, 1.2, 130), (200, 65, 2.4, 220),
                                                                (290, 20, 1.5, 120), (75, -35, 2.0, 70))):
        data = bpy.data.lights.new(f"light{number}", "AREA")
        data.size, data.energy = size, power
        data.color = ((1, 0.95, 0.88), (0.85, 0.92, 1), (1, 1, 1))[number % 3]
        light = bpy.data.objects.new(data.name, data)
        a, e = math.radians(azimuth), math.radians(elevation)
        at = 4.0 * Vector((math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)))
        light.matrix_world = Matrix.Translation(at) @ at.to_track_quat("Z", "Y").to_matrix().to_4x4()
        light.visible_camera = False
        bpy.context.collection.objects.link(light)
    world = bpy.data.worlds.new("room")
    world.use_nodes = True
    tree = world.node_tree
    place, split, ramp = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "ValToRGB"))
    scale = tree.nodes.new("ShaderNodeMapRange")
    scale.inputs["From Min"].default_value = -1
    ramp.color_ramp.elements[0].color = (0.05, 0.045, 0.04, 1)
    ramp.color_ramp.elements[1].color = (0.45, 0.50, 0.60, 1)
    tree.links.new(place.outputs["Generated"], split.inputs[0])
    tree.links.new(split.outputs["Z"], scale.inputs["Value"])
    tree.links.new(scale.outputs["Result"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    bpy.context.scene.world = world


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for make in (make_board, make_bowl, make_ball, make_wheel, make_tower, make_lights):
        make()
    bpy.context.view_layer.update()
