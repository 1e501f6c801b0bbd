#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random streams, which a decoder has to decode as the text decoder (spec/decoder.py) does.

    random_streams.py --decoder "slf decode {in} --dump {out} {options}" [--seeds FIRST LAST] [--keep DIRECTORY]

The streams of random_stream.py, each whole, in fewer levels, groups and layers, in a region, as a prefix, cut on purpose
(7.2), and damaged: both decoders have to give the same arrays, or both refuse.
Needs numpy. Exit code: 0 all agree, 1 some differ (those streams are kept), 2 usage.
"""
import argparse
import pathlib
import shlex
import subprocess
import sys
import tempfile

import numpy as np

from random_stream import RandomStream, text

ARRAYS = "positions", "components", "octahedral"        # others, as matrices, are the decoder's own


def decoded_by_text(request):
    """The arrays by name, or None where the text decoder refuses."""
    try:
        sequence, _, positions, components, normals = text.decode(*request)
    except text.Refused:
        return None
    arrays = {"positions": positions, "components": components}
    return {**arrays, "octahedral": normals} if sequence.normal_bits else arrays


def decoded_by(command, folder, request):
    """The arrays of the other decoder by name, None where it refuses; its exit code."""
    data, levels, groups, layers, region = request
    (folder / "stream.slf").write_bytes(data)
    for old in folder.glob("*.npy"):
        old.unlink()
    options = ["--levels", str(levels)] * bool(levels) + ["--groups", str(groups)] * bool(groups)
    options += ["--layers", str(layers)] * bool(layers)
    options += ["--region=" + ",".join(map(str, region))] * bool(region)     # as run.py
    words = []
    for word in shlex.split(command):
        words += options if word == "{options}" else [
            word.replace("{in}", str(folder / "stream.slf")).replace("{out}", str(folder))]
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True)
    if done.returncode:
        return None, done.returncode
    try:
        return {file.stem: np.load(file) for file in folder.glob("*.npy") if file.stem in ARRAYS}, 0
    except ValueError:                      # no array
        return {}, 0


def same(ours, others):
    """Whether both gave the same arrays, no more and no fewer; those of no numbers need not be there."""
    if ours is None or others is None:
        return ours is others
    ours, others = [{name: array for name, array in arrays.items() if array.size} for arrays in (ours, others)]
    return ours.keys() == others.keys() and all(
        array.shape == others[name].shape and (array == others[name]).all() for name, array in ours.items())


def tries_of(stream, decoder, folder):
    """The stream, what was asked, what both decoders gave, and the exit code of the other."""
    for request in stream.requests():
        asked = f"levels, groups, layers, region {request[1:]}"
        yield request[0], asked, decoded_by_text(request), *decoded_by(decoder, folder, request)


def compare(what, description, make, tries):
    """Compares the two decoders on what `make` makes of a seed; the exit code."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--decoder", required=True)
    parser.add_argument("--seeds", nargs=2, type=int, default=[0, 20], metavar=("FIRST", "LAST"))
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("."), metavar="DIRECTORY",
                        help="for streams that differ [.]")
    arguments = parser.parse_args()
    tried = refused = differ = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(*arguments.seeds):
            try:
                made = make(seed)
            except text.Refused:
                continue
            for number, (data, asked, ours, others, code) in enumerate(tries(made, arguments.decoder, pathlib.Path(folder))):
                tried, refused = tried + 1, refused + (ours is None)
                if code < 0 or not same(ours, others):
                    differ += 1
                    name = arguments.keep / f"random-{what}-{seed}-{number}.slf"
                    name.write_bytes(data)
                    print(f"{name}: {asked}, exit code {code}", file=sys.stderr)
    print(f"random {what}: {tried} decoded, {refused} of them refused, {differ} differ")
    return 1 if differ or not tried else 0


if __name__ == "__main__":
    sys.exit(compare("streams", __doc__, RandomStream, tries_of))
