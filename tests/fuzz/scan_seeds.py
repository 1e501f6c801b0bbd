# SPDX-License-Identifier: Apache-2.0
"""Seeds of scans."""
import struct


def las(minor, form):
    """Two points of format 2 (1.2) or 7 (1.4), and a record of a coordinate system."""
    header, record, colour = {2: (227, 26, 20), 7: (375, 36, 30)}[form]
    system = struct.pack("<H16sHH32s", 0, b"LASF_Projection", 2112, 8, b"") + b"PROJCS[\0"
    head = struct.pack("<4s20xBB68xHIIBHI20x3d3d48x", b"LASF", 1, minor, header, header + len(system), 1, form, record,
                       2 if form == 2 else 0, *[0.001] * 3, 4e5, 5.7e6, 100)
    if form == 7:
        head += struct.pack("<20xQ120x", 2)
    points = b"".join(struct.pack("<3i", *at).ljust(colour, b"\0") + struct.pack("<3H", 51200, 30720, 10240) for at in
                      ((0, 0, 0), (1500, -250, 1)))
    return {f"las1.{minor}": head + system + points.ljust(2 * record, b"\0")}


def e57():
    """Two points in pages of 1,024 bytes: 8-bit integers and floats. Checksums are the target's."""
    columns = (("cartesianX", 'type="ScaledInteger" minimum="0" maximum="255" scale="0.1"', bytes([3, 200])),
               ("cartesianY", 'type="Float" precision="single"', struct.pack("<2f", 1.5, -2)),
               ("cartesianZ", 'type="Float"', struct.pack("<2d", 0.25, 4)),
               *((f"color{name}", 'type="Integer" minimum="0" maximum="255"', bytes([9, 255])) for name in ("Red", "Green", "Blue")))
    packet = struct.pack(f"<H{len(columns)}H", len(columns), *(len(data) for _, _, data in columns))
    packet += b"".join(data for _, _, data in columns)
    packet += bytes(-(len(packet) + 4) % 4)
    section = struct.pack("<8sQQQ", b"\1", 32 + 4 + len(packet), 48 + 32, 0) + struct.pack("<BBH", 1, 0, 3 + len(packet)) + packet
    fields = "".join(f"<{name} {kind}/>" for name, kind, _ in columns)
    xml = (f'<e57Root type="Structure"><data3D type="Vector"><vectorChild type="Structure"><points type="CompressedVector" fileOffset="48" '
           f'recordCount="2"><prototype type="Structure">{fields}</prototype></points></vectorChild></data3D></e57Root>').encode()
    body = section + xml
    assert 48 + len(body) <= 1020 * 2 and 48 + len(section) < 1020
    body = body[:1020 - 48] + bytes(4) + body[1020 - 48:]
    return {"e57": struct.pack("<8sIIQQQQ", b"ASTM-E57", 1, 0, 0, 48 + len(section), len(xml), 1024) + body}


def scans():
    """Name: bytes."""
    return {**las(2, 2), **las(4, 7), **e57()}
