# SPDX-License-Identifier: Apache-2.0
"""What several tests share: a directory that goes away, manifests as files, runs with the fake slf."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

RD = pathlib.Path(__file__).resolve().parents[1]
FAKE = RD / "tests" / "fake_slf.py"

SMALL = {"label": "fig:order", "title": "Order", "figure": "curves", "captures": ["synth:can"], "grid": {"order": [1, 2, 3, 4]},
         "options": {"grid-bits": 7}, "rates": {"raht": [4, 8, 16, 32]}}


class Scratch(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.calls = self.folder / "calls.txt"

    def manifest(self, name="m.json", text=None, **changes):
        """A file with SMALL and changes (None takes a key away), or with `text`."""
        path = self.folder / name
        value = {k: v for k, v in {**SMALL, **changes}.items() if v is not None}
        path.write_text(text if text is not None else json.dumps(value, indent=1), encoding="utf-8")
        return path

    def rd(self, *words, slf=FAKE):
        """(exit code, standard output, standard error) of rd.py."""
        environment = {**os.environ, "FAKE_SLF_CALLS": str(self.calls)}
        environment.pop("SLF_DATA", None)
        done = subprocess.run([sys.executable, str(RD / "rd.py"), *map(str, words), "--slf", str(slf), "--cores", "2", "--out",
                               str(self.folder / "out")], capture_output=True, text=True, env=environment, cwd=self.folder)
        return done.returncode, done.stdout, done.stderr

    def called(self, verb):
        """Calls of a verb of the fake since the last time."""
        lines = [line for line in self.calls.read_text().splitlines()] if self.calls.exists() else []
        self.calls.unlink(missing_ok=True)
        return [line for line in lines if line.split()[:1] == [verb] and "--list" not in line]
