# SPDX-License-Identifier: Apache-2.0
"""The table that tools/demo.sh prints, from the JSON reports of the steps."""
import json
import os
import statistics
import sys


def load(name):
    path = os.path.join(sys.argv[1], name)
    if not os.path.exists(path):
        return None
    with open(path) as file:
        return json.load(file)


def quality(name, q):
    row(name + " point PSNR", "%.2f dB (%d cameras)" % (q["points"][0]["psnr"], q["cameras"]))
    row(name + " image PSNR", "%.2f dB, SSIM %.3f, coverage %.1f %%" % (
        q["image"]["psnr"], q["image"]["ssim"], 100 * q["image"]["coverage"]))


def row(name, value):
    print("  %-22s %s" % (name, value))


encode, decode, render, measured = (load(n + ".json") for n in ("encode", "decode", "render", "eval"))
seconds = encode["seconds"]
print()
row("capture", sys.argv[2])
row("points", "{:,}".format(encode["points"]))
row("input images", encode["cameras"])
row("file", "{:,} bytes".format(encode["bytes"]))
row("rate", "%.2f bits per point, all functions of direction included" % encode["bits_per_point"])
if measured:
    quality("input", measured["input"])
    if "held_out" in measured:
        quality("held-out", measured["held_out"])
row("encode", "%.2f s (observe %.2f, fit %.2f, code %.2f), peak %.0f MiB" % (
    seconds["total"], seconds["observe"], seconds["fit"], seconds["code"], encode["peak_memory_mib"]))
if measured:
    row("decode", "%.3f s on all cores" % measured["decode"]["total"])
row("decode to PLY", "%.3f s, of the mean colour alone" % decode["seconds"])
views = render["images"]
row("render", "%.3f s per view of %d x %d" % (statistics.median(v["seconds"] for v in views), *views[0]["size"]))
row("the whole demo", "%s s after the build" % sys.argv[3])
row("look at", os.path.join(sys.argv[1], "contact_sheet.png") + ", demo.slf, demo.ply, orbit/")
