#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The laboratory's options have the ranges of the program's settings.

usage: settings_table_test.py SLF TOOLS_RD
"""
import json
import subprocess
import sys

sys.path.insert(0, sys.argv[2])
import options as opt  # noqa: E402

OWN = {"dc", "chroma", "speed", "av1-speed"}  # --penalise-dc and --free-dc; those of slf igc


def same(setting, limits):
    """Does an option of the laboratory take what the setting takes? Words may be fewer."""
    parts = limits.ranges if isinstance(limits, opt.Either) else [limits]
    words, ranges = [], []
    for part in parts:
        if isinstance(part, opt.Choice):
            words += [str(value) for value in part.values]
        elif isinstance(part, opt.Number):
            ranges.append((part.low, part.high))
    if setting["kind"] in ("flag", "text"):
        return True
    of_setting = [(setting["low"], setting["high"])] if "low" in setting else []
    return set(words) <= set(setting.get("words", [])) and ranges == of_setting


def main():
    table = json.loads(subprocess.run([sys.argv[1], "settings", "--json"], check=True, capture_output=True).stdout)
    settings = {setting["name"]: setting for setting in table}
    rates = [(name, limits) for codec, (name, limits) in opt.RATES.items() if codec in ("raht", "tmc")]
    wrong = [name for name, limits in [(name, limits) for name, (limits, _) in opt.OPTIONS.items()] + rates
             if name not in OWN and (name not in settings or not same(settings[name], limits))]
    for name in wrong:
        print(f"{name}: {settings.get(name, 'not a setting')}")
    return 1 if wrong else 0


sys.exit(main())
