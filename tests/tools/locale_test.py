#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A process whose numbers have decimal commas writes and reads the same files.

    tests/tools/locale_test.py SLF DECIMAL_COMMAS

Each command runs in the C locale, and again as a process that has set de_DE.UTF-8 (tests/tools/decimal_commas.cpp): files
and reports for programs are the same bytes. Exit code 77: localedef or the locale's source is missing.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# What each writes is read by those after it. {0}: the directory of the run. No option has a decimal point: the parser of
# the command line follows the locale, which slf itself never sets.
COMMANDS = [
    "synth can -o {0}/can --size 48x48 --points 600",
    "encode {0}/can -o {0}/x.slf -q 16 --surface given --quiet",
    "info {0}/x.slf --json --quiet",
    "info {0}/x.slf --syntax --json --quiet",
    "decode {0}/x.slf -o {0}/x.ply --dump {0}/dump --quiet",
    "export {0}/x.slf -o {0}/splats.ply --quiet",
    "export {0}/x.slf -o {0}/splats.glb --quiet",
    "render {0}/x.slf -o {0}/x.png --size 40x40 --quiet",
    "truncate {0}/x.slf --levels 4 -o {0}/cut.slf --quiet",
    "eval {0}/x.slf {0}/can --json --quiet",
    "settings --json",
]


def run_all(program, directory, environment):
    """What the commands print, seconds and memory and the name of the directory taken out; files are in the directory."""
    said = []
    for command in COMMANDS:
        done = subprocess.run([program, *command.format(directory).split()], env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{command}: exit code {done.returncode}: {done.stderr}")
        text = re.sub(r'"(\w*seconds\w*|peak_memory|\w+_per_second)": *[-+.e\d]+|"(seconds|decode)": *\{[^}]*\}', "", done.stdout)
        said.append(text.replace(str(directory), ""))
    return said


def files_of(directory):
    return {str(file.relative_to(directory)): file.read_bytes() for file in sorted(directory.rglob("*")) if file.is_file()}


def main():
    program, library = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as scratch:
        locales, plain, commas = (pathlib.Path(scratch, name) for name in ("locales", "plain", "commas"))
        for directory in (locales, plain, commas):
            directory.mkdir()
        try:
            subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", "--no-archive", str(locales / "de_DE.UTF-8")], capture_output=True)
        except FileNotFoundError:
            pass
        if not (locales / "de_DE.UTF-8").exists():
            print("skipped: no localedef, or no source of de_DE (Debian's package locales)")
            return 77
        base = {name: value for name, value in os.environ.items() if not name.startswith("LC_") and name != "LANG"}
        said = run_all(program, plain, {**base, "LC_ALL": "C"})
        preload = " ".join(filter(None, [os.environ.get("LD_PRELOAD"), library]))
        again = run_all(program, commas, {**base, "LC_ALL": "de_DE.UTF-8", "LOCPATH": str(locales), "LD_PRELOAD": preload})
        wrong = [command for command, one, other in zip(COMMANDS, said, again) if one != other]
        one, other = files_of(plain), files_of(commas)
        wrong += [name for name in sorted(one.keys() | other.keys()) if one.get(name) != other.get(name)]
        for name in wrong:
            print("DIFFERS:", name)
        print(f"{len(COMMANDS)} commands, {len(one)} files, {len(wrong)} differ")
        return 1 if wrong or len(one) < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
