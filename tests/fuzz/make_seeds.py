#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seeds of the fuzz targets: small files of every format, OUT/TARGET/NAME.

    tests/fuzz/make_seeds.py OUT [--slf build/bin/slf]

Streams are conformance streams below 4 kB, and refused ones; the rest is written here, byte by byte.
With --slf there are files of its encoder, .igc files, plans and parts of scenes too.
"""
import argparse
import json
import pathlib
import struct
import zlib

from encoded_seeds import igc, light_fields, scene
from scan_seeds import scans

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MARK = b"\xff\xfe\xff"  # between the files of one input
MOST_BYTES = 4096


def streams():
    """Name and bytes of conformance streams, small ones first."""
    files = sorted(ROOT.glob("conformance/*/*/stream.slf"), key=lambda file: file.stat().st_size)
    return [(file.parent.name, file.read_bytes()) for file in files if file.stat().st_size <= MOST_BYTES]


def hevc(stream):
    """The HEVC bytes of the first unit that has some, with the byte of the target before them."""
    at = stream.find(b"\x00\x00\x00\x01\x40\x01")
    return None if at < 0 else b"\x01" + stream[at:]


def chunk(kind, body):
    """A chunk of a PNG."""
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(depth, colour, channels, palette=b""):
    """4 x 4 pixels."""
    row = b"\x00" + bytes(range(4 * channels * depth // 8))
    body = chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, depth, colour, 0, 0, 0))
    if palette:
        body += chunk(b"PLTE", palette) + chunk(b"tRNS", bytes(len(palette) // 3))
    return b"\x89PNG\r\n\x1a\n" + body + chunk(b"IDAT", zlib.compress(row * 4)) + chunk(b"IEND", b"")


def jpeg():
    """8 x 8 grey pixels, baseline, of one DC coefficient."""
    def segment(marker, body):
        return bytes([0xFF, marker]) + struct.pack(">H", len(body) + 2) + body
    table = bytes([1] + [0] * 15 + [0])  # one code of one bit: 0
    return (b"\xff\xd8" + segment(0xDB, b"\x00" + bytes([16] * 64))
            + segment(0xC0, struct.pack(">BHHB", 8, 8, 8, 1) + bytes([1, 0x11, 0]))
            + segment(0xC4, b"\x00" + table) + segment(0xC4, b"\x10" + table)
            + segment(0xDA, bytes([1, 1, 0x00, 0, 63, 0])) + b"\x3f" + b"\xff\xd9")


def npy(kind, shape, body):
    """A NumPy file of version 1."""
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + body


def ply(form, body):
    """Three vertices with colours, a face."""
    return (f"ply\nformat {form} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n").encode() + body


def glb():
    """A triangle with indices, under a node that turns."""
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    body = points + struct.pack("<3H", 0, 1, 2) + b"\x00\x00"
    scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(body)}], "scene": 0,
             "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 3]}],
             "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                           {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]}
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def splats():
    """Two Gaussian splats in every format: PLY as text, binary and SuperSplat's, SPZ 1 to 3 as they are within gzip, splat,
    ksplat of floats and of bytes with short headers, glTF, and the beginnings of what is refused by name."""
    names = [*"xyz", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(9)), "opacity", "scale_0", "scale_1", "scale_2",
             "rot_0", "rot_1", "rot_2", "rot_3"]
    row = [0.5, 1, 2, 0.1, 0.2, 0.3, *([0.05] * 9), 1.5, -3, -3, -4, 1, 0, 0, 0]

    def head(form):
        return (f"ply\nformat {form} 1.0\nelement vertex 2\n" + "".join(f"property float {n}\n" for n in names) + "end_header\n").encode()
    bounds = [f"{end}_{kind}{axis}" for kind in ("", "scale_") for end in ("min", "max") for axis in "xyz"]
    packed = "ply\nformat binary_little_endian 1.0\nelement chunk 1\n" + "".join(f"property float {n}\n" for n in bounds)
    packed += "element vertex 2\n" + "".join(f"property uint packed_{n}\n" for n in ("position", "rotation", "scale", "color"))
    packed += "end_header\n"
    made = {"ascii.ply": head("ascii") + (" ".join(map(str, row)) + "\n").encode() * 2,
            "binary.ply": head("binary_little_endian") + struct.pack("<23f", *row) * 2,
            "compressed.ply": packed.encode() + struct.pack("<12f", *([-1] * 3), 1, 1, 1, *([-6] * 3), -2, -2, -2) + bytes(range(32)),
            "x.splat": (struct.pack("<6f", 1, 2, 3, 0.1, 0.1, 0.2) + bytes([9, 99, 199, 200, 255, 128, 128, 128])) * 2}
    for version, each in ((1, 6 + 10), (2, 9 + 10), (3, 9 + 11)):
        made[f"{version}.spz"] = struct.pack("<4sIIBBBB", b"NGSP", version, 2, 1, 12, 0, 0) + bytes(range(2 * (each + 9)))
    made["4.spz"] = struct.pack("<4sII20x", b"NGSP", 4, 2)
    for level, each in ((0, 44), (2, 24)):
        main = struct.pack("<BBHIIIIH", 0, 1, 0, 1, 1, 2, 2, level).ljust(48, b"\0")
        section = struct.pack("<IIIIfHHIIIIH", 2, 2, 2, 1, 5, 12, 0, 0, 0, 1, 0, 0).ljust(48, b"\0")
        made[f"{level}.ksplat"] = b"KS" + main + section + bytes(12) + bytes(range(2 * each))
    keys = [("POSITION", 12), ("ROTATION", 16), ("SCALE", 12), ("OPACITY", 4), ("SH_DEGREE_0_COEF_0", 12)]
    views = [{"buffer": 0, "byteOffset": sum(n for _, n in keys[:i]), "byteLength": n} for i, (_, n) in enumerate(keys)]
    body = struct.pack("<14f", 1, 2, 3, 0, 0, 0, 1, 0.1, 0.1, 0.1, 0.5, 0.1, 0.2, 0.3)
    scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(body)}], "scenes": [{"nodes": [0]}], "bufferViews": views,
             "nodes": [{"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0.6, 0, 0.8]}], "accessors": [
                 {"bufferView": i, "componentType": 5126, "count": 1, "type": {4: "SCALAR", 12: "VEC3", 16: "VEC4"}[n]}
                 for i, (_, n) in enumerate(keys)],
             "meshes": [{"primitives": [{"mode": 0, "extensions": {"KHR_gaussian_splatting": {"kernel": "ellipse"}}, "attributes": {
                 ("" if name == "POSITION" else "KHR_gaussian_splatting:") + name: i for i, (name, _) in enumerate(keys)}}]}]}
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return {**made, "x.glb": struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks,
            "x.sog": b"PK\3\4" + bytes(26) + b"meta.json"}


def cameras():
    """cameras.json, transforms.json of one focal length and with distortion."""
    unit = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 3], [0, 0, 0, 1]]
    ours = {"cameras": [{"image": "a.png", "width": 4, "height": 4, "K": [[5, 0, 2], [0, 5, 2], [0, 0, 1]],
                         "R": [row[:3] for row in unit[:3]], "t": [0, 0, 3]}], "splits": {"dense": ["a.png"]}}
    frames = [{"file_path": "a.png", "transform_matrix": unit}]
    blender = {"camera_angle_x": 0.7, "w": 4, "h": 4, "frames": frames}
    nerf = {"fl_x": 5, "fl_y": 5, "cx": 2, "cy": 2, "w": 4, "h": 4, "k1": 0.1, "k2": 0, "p1": 0, "p2": 0,
            "camera_model": "OPENCV", "ply_file_path": "points.ply", "frames": frames}
    return {"ours": ours, "blender": blender, "nerf": nerf}


def other_cameras():
    """One camera of Bundler (with its list.txt), Metashape and openMVG, each with a lens that bends."""
    bundle = (b"# Bundle file v0.3\n2 1\n5 0.1 0\n1 0 0\n0 -1 0\n0 0 -1\n0 0 -3\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
              b"0 0 0\n9 8 7\n1 0 3 0.5 0.5\n")
    numbers = {"f": 5, "cx": 0.1, "cy": 0, "k1": 0.01, "k2": 0, "k3": 0.001, "p1": 0.01, "b1": 0.1}
    xml = ('<?xml version="1.0"?><document version="2.0.0"><chunk><sensors><sensor id="0" type="frame"><resolution width="4" '
           'height="4"/><calibration class="adjusted">' + "".join(f"<{k}>{v}</{k}>" for k, v in numbers.items()) +
           '</calibration></sensor></sensors><components><component id="1"><transform><rotation>1 0 0 0 1 0 0 0 1</rotation>'
           '<translation>1 2 3</translation><scale>2</scale></transform></component></components><cameras><group><camera id="0" '
           'sensor_id="0" component_id="1" label="a"><transform>1 0 0 0 0 1 0 0 0 0 1 -3 0 0 0 1</transform></camera></group>'
           '<camera id="1" sensor_id="0" label="b"/></cameras></chunk></document>')

    def keyed(key, data):
        return {"key": key, "value": {"ptr_wrapper": {"data": data}}}
    mvg = {"sfm_data_version": "0.3",
           "views": [keyed(0, {"local_path": "", "filename": "a.png", "id_view": 0, "id_intrinsic": 0, "id_pose": 0})],
           "intrinsics": [keyed(0, {"value0": {"width": 4, "height": 4, "focal_length": 5, "principal_point": [2, 2]},
                                    "disto_t2": [0.1, 0, 0.001, 0, 0]})],
           "extrinsics": [{"key": 0, "value": {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "center": [0, 0, -3]}}],
           "structure": [{"key": 0, "value": {"X": [0, 0, 0]}}]}
    return {"bundler": bundle + MARK + b"a.png\nb.png 0 5\n", "metashape": xml.encode(), "openmvg": json.dumps(mvg).encode()}


def plenoptic():
    """Two points with three views each."""
    names = [f"{c}{v}" for v in range(3) for c in ("r", "g", "b")]
    head = ("ply\nformat binary_little_endian 1.0\ncomment view 0 1 2 3\ncomment view 1 4 5 6\ncomment view 2 7 8 9\n"
            "element vertex 2\n" + "".join(f"property float {k}\n" for k in "xyz") +
            "".join(f"property uchar {k}\n" for k in names) + "end_header\n")
    return head.encode() + b"".join(struct.pack("<3f9B", i, 0, 1, *range(9)) for i in range(2))


def stl():
    """A triangle, binary and ASCII."""
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    return {"binary.stl": bytes(80) + struct.pack("<I", 1) + facet,
            "ascii.stl": b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                         b"endfacet\nendsolid a\n"}


def glb_draco():
    """A cube that Draco 1.5.5 compressed."""
    body = bytes.fromhex("445241434f02020101000000080c000b0000035f4b0b01011001ff000001000903000002010101010103552d0108ad0a068c35750a"
                         "338300000000ff000000000000000000803f000000400000004008")
    draco = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(body)}], "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "bufferViews": [{"buffer": 0, "byteLength": len(body)}],
             "accessors": [{"componentType": 5126, "count": 8, "type": "VEC3"}, {"componentType": 5123, "count": 36, "type": "SCALAR"}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions": draco}]}]}
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def colmap():
    """A model of one camera, one image, one point, as text and as binary."""
    text = MARK.join([b"1 PINHOLE 4 4 5 5 2 2\n", b"1 1 0 0 0 0 0 3 1 a.png\n2 2 1\n",
                      b"1 0 0 0 9 8 7 0.5 1 0\n"])
    camera = struct.pack("<QIiQQ4d", 1, 1, 1, 4, 4, 5, 5, 2, 2)
    image = struct.pack("<QI7dI", 1, 1, 1, 0, 0, 0, 0, 0, 3, 1) + b"a.png\0" + struct.pack("<QddQ", 1, 2, 2, 1)
    point = struct.pack("<QQ3d3BdQII", 1, 1, 0, 0, 0, 9, 8, 7, 0.5, 1, 1, 0)
    return {"text": text, "binary": MARK.join([camera, image, point])}


def seeds(program):
    """Target: name: bytes."""
    made = {target: {} for target in
            "decode frames render truncate annotate export part_decoder html hevc npy ply scan obj glb image cameras colmap splats igc part plan".split()}
    for name, stream in streams():
        made["decode"][name] = made["render"][name] = stream
        if name.startswith("frames-"):
            made["frames"][name] = stream
        made["html"][name] = stream
        made["truncate"][name] = b"\x03\x01" + stream
        made["annotate"][name] = b"\x07\x40" + stream
        made["part_decoder"][name] = b"\x03\x01" + stream
        made["part_decoder"][name + "-region"] = b"\x40\x05" + stream
        made["export"][name] = bytes([len(made["export"]) % 6, 1]) + stream
        if hevc(stream):
            made["hevc"][name] = hevc(stream)
    made["npy"]["int32"] = npy("<i4", (2, 3), bytes(24))
    made["npy"]["int64"] = npy(">i8", (1, 1, 3), bytes(24))
    made["npy"]["float"] = npy("<f4", (2,), bytes(8))
    values = [struct.pack(order + "fff3B", *point) for order in "<>" for point in
              ((0, 0, 0, 1, 2, 3), (1, 0, 0, 4, 5, 6), (0, 1, 0, 7, 8, 9))]
    made["ply"]["ascii"] = ply("ascii", b"0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2\n")
    made["ply"]["little"] = ply("binary_little_endian", b"".join(values[:3]) + struct.pack("<B3i", 3, 0, 1, 2))
    made["ply"]["big"] = ply("binary_big_endian", b"".join(values[3:]) + struct.pack(">B3i", 3, 0, 1, 2))
    made["obj"]["triangle"] = b"v 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf -1 -2 -3 1\n"
    made["obj"].update(stl())
    made["ply"]["plenoptic"] = plenoptic()
    made["scan"] = scans()
    made["glb"] = {"triangle": glb(), "draco": glb_draco()}
    made["image"] = {"grey.png": png(8, 0, 1), "rgb16.png": png(16, 2, 3), "rgba.png": png(8, 6, 4),
                     "palette.png": png(8, 3, 1, bytes(range(12))), "grey.jpg": jpeg(),
                     "text.ppm": b"P3 # a comment\n2 1 255\n9 8 7 255 0 1\n", "grey16.pgm": b"P5\n2 2\n65535\n" + bytes(range(8))}
    made["cameras"] = {name: json.dumps(value).encode() for name, value in cameras().items()}
    made["cameras"].update(other_cameras())
    made["colmap"] = colmap()
    made["splats"] = splats()
    if program:
        for name, stream in light_fields(program, splats()["binary.ply"]).items():
            for target in ("decode", "render", "html"):
                made[target]["encoded-" + name] = stream
            for kind in range(6):
                made["export"][f"encoded-{name}-{kind}"] = bytes([kind, 1 + 4 * (kind % 3)]) + stream
            for how, lead in (("levels", b"\x03\x00"), ("groups", b"\x00\x01"), ("region", b"\x40\x07"), ("bytes", b"\x80\x50")):
                made["part_decoder"][f"encoded-{name}-{how}"] = made["truncate"][f"encoded-{name}-{how}"] = lead + stream
        made["igc"]["can"] = igc(program)
        made["plan"]["saddle"], first, second = scene(program)
        made["part"] = {"first": first, "second": second, "both": MARK.join([first, second])}
    return made


def main():
    """Writes them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--slf")
    given = parser.parse_args()
    program = str(pathlib.Path(given.slf).resolve()) if given.slf else None
    for target, files in seeds(program).items():
        (given.out / target).mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            (given.out / target / name).write_bytes(content)


if __name__ == "__main__":
    main()
