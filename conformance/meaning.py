#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the streams mean: meaning.json, by stream the header, and colours of points along directions (spec 6, 7.2).

    meaning.py            checks that meaning.json is current
    meaning.py --write    writes it

Headers are what the text decoder, spec/decoder.py, reads. Colours are evaluated in double precision from the definitions of
clause 6 by docs/examples/radiance.py, from the integers of the text decoder: a decoder has to come within 1/16 of a grey level (6.7).
Needs numpy. Exit code: 0, 1: not current.
"""
import json
import pathlib
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "spec"), str(HERE.parent / "docs/examples")]
import decoder  # noqa: E402
import radiance  # noqa: E402

DIRECTIONS = [(1, 0, 0), (-0.3, -0.9, 0.2), (0.01, -0.02, 1), (-1, 1e-9, -1), (0.5, 0.5, -0.4)]
CLAMPED = ["basis", "harmonics"]            # whose colours are 0 or 255 all


def colours(sequence, header, data):
    """Points, directions and R, G, B, of a stream with a basis and without joint transforms."""
    sequence, coded, positions, components, _ = decoder.decode(data, 0, 0, 0, [])
    found = []
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        np.save(place / "positions.npy", positions.astype("<i4"))
        np.save(place / "components.npy", components.astype("<i4"))
        to_rgb = np.eye(3)
        if header["colour"]["transform"] == "opponent":
            to_rgb = np.array([[1, 1, 1], [1, 0, -1], [1, -2, 1]]).T / np.sqrt([3, 2, 6])
        transforms = []
        for i, transform in enumerate(sequence.transforms):
            np.save(place / f"matrix_{i}.npy", transform.matrix.T)
            transforms.append({"functions": transform.functions, "joint": transform.joint, "matrix": f"matrix_{i}.npy",
                               "components": [coded.index(k) for k in transform.functions[:transform.rank]],
                               "colour": transform.colour.tolist()})
        whole = {**header, "component_function": coded, "transforms": transforms}
        whole["colour"] = {"to_rgb": to_rgb.tolist()}
        (place / "light_field.json").write_text(json.dumps(whole), encoding="utf-8")
        for i, direction in enumerate(DIRECTIONS):
            point = i * (len(positions) - 1) // (len(DIRECTIONS) - 1)
            _, rgb = radiance.radiance(folder, point, direction)
            found.append({"point": point, "direction": direction, "rgb": [round(float(c), 4) for c in rgb]})
    return found


def meaning(folder):
    """What one stream means; None for Draco, which the text decoder does not read."""
    data = (folder / "stream.slf").read_bytes()
    try:
        sequence = decoder.Sequence(decoder.read_units(data)[0][1])
    except decoder.Refused:
        return None
    header = decoder.header_of(sequence, decoder.Wanted(sequence, 0, 0, 0).shift)
    found = {"header": {**header, "normal_bits": sequence.normal_bits}}
    if header["has_basis"] and folder.name not in CLAMPED:
        found["radiance"] = colours(sequence, header, data)
    return found


def main():
    made = {folder.name: meaning(folder) for folder in sorted((HERE / "streams").iterdir())}
    lines = [f"{json.dumps(name)}: {json.dumps(each)}" for name, each in made.items() if each]
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    path = HERE / "meaning.json"
    if "--write" in sys.argv:
        path.write_text(text, encoding="utf-8")
    current = path.read_text(encoding="utf-8") == text
    print(f"meaning.json of {len(lines)} streams is {'' if current else 'not '}current")
    return 0 if current else 1


if __name__ == "__main__":
    sys.exit(main())
