# SPDX-License-Identifier: Apache-2.0
"""The codecs, their rate options and every option a manifest may set, with ranges.

Ranges are those of `slf settings`, kept here so that an impossible manifest is refused before anything
runs; tests/house/settings_table_test.py compares them.
"""

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


# The rate knob of each codec: option of the program and its range. A step is always given: with the
# program's own choice, --quality auto and --quality-loss, a job would have no rate of its own.
RATES = {"raht": ("quality", Number(0.05, 4096)), "tmc": ("texture-qp", Number(0, 51, whole=True)),
         "tmc3": ("qp", Number(4, 51, whole=True)), "igc-hevc": ("qp", Number(0, 51, whole=True)),
         "igc-hevc-intra": ("qp", Number(0, 51, whole=True)), "igc-av1": ("qp", Number(0, 63, whole=True))}

X265_PRESETS = ("ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow")

# name: (range, codecs that take it)
OPTIONS = {
    "grid-bits": (Either(Number(1, 21, whole=True), Choice("auto")), CODECS),
    "delta": (Number(0, 90), CODECS),
    "occlusion-resolution": (Number(0.05, 8), CODECS),
    "depth-tolerance": (Number(0, 1000), CODECS),
    "order": (Number(1, 4, whole=True), CODECS),
    "functions": (Number(1, 4096, power_of_two=True), CODECS),
    "lambda": (Number(0, 1e9), CODECS),
    "beta": (Number(0, 1e9), CODECS),
    "iterations": (Number(0, 100, whole=True), CODECS),
    "neighbours": (Number(1, 64, whole=True), CODECS),
    "dc": (Choice("penalise", "free"), CODECS),
    "linear": (Flag(), CODECS),
    "fit": (Choice("paper", "hierarchical"), CODECS),
    "fit-to": (Choice("points", "pictures"), CODECS),
    "basis": (Choice("bspline", "harmonics", "auto"), CODECS),
    "frame": (Choice("global", "reflected", "auto"), CODECS),
    "cross-validate": (Choice("on", "off"), CODECS),
    "check-cameras": (Choice("on", "off"), ("raht", "tmc")),
    "effort": (Number(1, 8, whole=True), CODECS),
    "degree": (Number(0, 10, whole=True), CODECS),
    "block-log2": (Number(0, 21, whole=True), CODECS),
    "block-strength": (Number(1e-6, 1e6), CODECS),
    "block-growth": (Number(1, 10), CODECS),
    "point-penalty": (Number(1e-6, 1e9), CODECS),
    "point-growth": (Number(1, 10), CODECS),
    "environment-degree": (Number(0, 16, whole=True), CODECS),
    "environment-radius": (Either(Number(2, 1e6), Choice(0)), CODECS),
    "predict": (Choice("on", "off"), ("raht",)),
    "klt": (Choice("off", "functions", "joint"), ("raht",)),
    "rdo": (Number(0, 1), ("raht",)),
    "chroma-step": (Number(0.1, 10), ("raht", "tmc")),
    "steps": (Choice("by-norm", "uniform"), ("raht", "tmc")),
    "colour": (Choice("opponent", "none"), ("raht", "tmc")),
    "coefficients": (Choice("vector", "independent"), ("raht",)),
    "texture-bits": (Choice(8, 10, 12), ("tmc",)),
    "texture-mode": (Choice("intra", "low-delay"), ("tmc",)),
    "texture-preset": (Choice(*X265_PRESETS), ("tmc",)),
    "chroma": (Choice(420, 444), IGC),
    "speed": (Choice(*X265_PRESETS), ("igc-hevc", "igc-hevc-intra")),
    "av1-speed": (Number(0, 8, whole=True), ("igc-av1",)),  # --speed as well, of another scale
}


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
