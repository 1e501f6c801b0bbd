# SPDX-License-Identifier: Apache-2.0
"""The codecs, their rate options and every option a manifest may set, with ranges.

Ranges are those of `slf settings --json`, read once, so that an impossible manifest is refused before
anything runs.
"""
import json
import os
import pathlib
import subprocess

SLF = ("raht", "tmc", "tmc3")
IGC = ("igc-hevc", "igc-hevc-intra", "igc-av1")
CODECS = SLF + IGC
PRESETS = ("paper", "default")


class Number:
    def __init__(self, low, high, whole=False, power_of_two=False):
        self.low, self.high, self.whole, self.power_of_two = low, high, whole or power_of_two, power_of_two

    def problem(self, value):
        """None, or what is expected instead."""
        sound = isinstance(value, (int, float)) and not isinstance(value, bool) and self.low <= value <= self.high
        if sound and (not self.whole or isinstance(value, int)) and not (self.power_of_two and value & (value - 1)):
            return None
        kind = "a power of two" if self.power_of_two else "a whole number" if self.whole else "a number"
        return f"{kind} {self.low:g} to {self.high:g} is expected"


class Choice:
    def __init__(self, *values):
        self.values = values

    def problem(self, value):
        return None if value in self.values and not isinstance(value, bool) else \
            f"one of {', '.join(map(str, self.values))} is expected"


class Flag:
    """An option without a value: true gives it, false does not (and takes back a true of `options`)."""

    def problem(self, value):
        return None if isinstance(value, bool) else "true or false is expected"


class Either:
    def __init__(self, *ranges):
        self.ranges = ranges

    def problem(self, value):
        problems = [r.problem(value) for r in self.ranges]
        return None if None in problems else " or ".join(problems)


# The rate knob of each codec: option of the program, and its range where that is not the program's own. A step is always
# given: with the program's own choice, --quality auto and --quality-loss, a job would have no rate of its own.
RATES = {"raht": ("quality", None), "tmc": ("texture-qp", None),
         "tmc3": ("qp", Number(4, 51, whole=True)), "igc-hevc": ("qp", Number(0, 51, whole=True)),
         "igc-hevc-intra": ("qp", Number(0, 51, whole=True)), "igc-av1": ("qp", Number(0, 63, whole=True))}

X265_PRESETS = ("ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow")

# Settings of the coder that textures take as well; of the others, those that coefficients alone have.
OF_TEXTURES_TOO = ("chroma-step", "steps", "colour")
# The rate is a job's own.
NOT_OPTIONS = ("preset", "quality", "quality-loss", "target-bytes", "target-bitrate", "target-psnr", "texture-qp", "texture-lossless",
               "penalise-dc", "free-dc")
# name: (range, codecs that take it), of what the program has in another form or for slf igc alone
OWN = {
    "dc": (Choice("penalise", "free"), CODECS),
    "functions": (Number(1, 4096, power_of_two=True), CODECS),
    "texture-preset": (Choice(*X265_PRESETS), ("tmc",)),
    "chroma": (Choice(420, 444), IGC),
    "speed": (Choice(*X265_PRESETS), ("igc-hevc", "igc-hevc-intra")),
    "av1-speed": (Number(0, 8, whole=True), ("igc-av1",)),  # --speed as well, of another scale
}
PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "build" / "bin" / "slf"
_options, _rates = {}, {}


def load(slf):
    """Takes the options of a program: one is loaded at a time."""
    table = json.loads(subprocess.run([slf, "settings", "--json"], check=True, capture_output=True).stdout)
    _options.clear()
    _options.update({row["name"]: (_range(row), _codecs(row)) for row in table
                     if row["name"] not in NOT_OPTIONS and row["kind"] not in ("text", "pair")}, **OWN)
    _rates.update({row["name"]: Number(row["low"], row["high"], whole=row["kind"] == "whole") for row in table if "low" in row})


def options():
    """name: (range, codecs that take it) of every option that a manifest may set."""
    if not _options:
        load(os.environ.get("SLF_PROGRAM", PROGRAM))
    return _options


def rate(codec):
    """Name and range of the rate knob of a codec."""
    options()
    name, limits = RATES[codec]
    return name, limits or _rates[name]


def _range(row):
    if row["kind"] == "flag":
        return Flag()
    words = [int(word) if word.isdigit() else word for word in row.get("words", [])]
    parts = [Number(row["low"], row["high"], whole=row["kind"] == "whole")] if "low" in row else []
    parts += [Choice(*words)] if words else []
    return parts[0] if len(parts) == 1 else Either(*parts)


def _codecs(row):
    if row["group"] == "Coding":
        return ("raht", "tmc") if row["name"] in OF_TEXTURES_TOO else ("raht",)
    if row["group"].startswith("Texture"):
        return ("tmc",)
    return ("raht", "tmc") if row["name"] in ("match-exposure", "check-cameras") else CODECS


def words(options):
    """Command line words of options, in a fixed order."""
    out = []
    for name, value in sorted(options.items()):
        if name == "dc":
            out.append(f"--{value}-dc")
        elif isinstance(value, bool):
            out += [f"--{name}"] if value else []
        else:
            out += ["--" + name.removeprefix("av1-"), f"{value:g}" if isinstance(value, float) else str(value)]
    return out


def coded_name(job):
    """What the file of a job is called, in its directory."""
    return "coded.igc" if job["codec"].startswith("igc") else "coded.slf"


def encode_command(slf, job, output, threads):
    """The words that encode one job to `output` and print a JSON report."""
    common = [job["capture"]["directory"], "-o", output, "--preset", job["preset"], "--split", job["slf_split"],
              "--threads", str(threads), "--json"]
    if job["capture"]["points"]:
        common += ["--points", job["capture"]["points"]]
    common += words(job["options"])
    codec, rate = job["codec"], f"{job['rate']:g}"
    if codec == "raht":
        return [slf, "encode", *common, "--quality", rate]
    if codec == "tmc":
        return [slf, "encode", *common, "--coefficients", "texture", "--texture-qp", rate]
    return [slf, "igc", *common, "--codec", codec.removeprefix("igc-"), "--qp", rate]


def eval_command(slf, job, coded, threads):
    out = [slf, "eval", coded, job["capture"]["directory"], "--delta-eval", ",".join(f"{d:g}" for d in job["deltas"]),
           "--threads", str(threads), "--json"]
    if job["capture"]["points"]:
        out += ["--points", job["capture"]["points"]]
    return out if job["images"] else out + ["--no-images"]
