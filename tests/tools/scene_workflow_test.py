#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/scene: the workflow makes what one process makes, and makes again only what is lost.

    scene_workflow_test.py ROOT SLF
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT, SLF = pathlib.Path(sys.argv[1]), sys.argv[2]
SETTINGS = ["--slice-points", "2500", "--effort", "1", "--degree", "2", "--grid-bits", "8"]


def run(*words, **more):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, **more)


class Workflow(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.place = pathlib.Path(cls.directory.name)
        made = run(SLF, "synth", "terrace", "-o", cls.place / "street", "--houses", 2, "--points", 12000, "--cameras", 8,
                   "--size", "64x48", "--quiet")
        assert made.returncode == 0, made.stderr
        run(SLF, "encode", cls.place / "street", "-o", cls.place / "whole.slf", "--memory", "1G", "--quiet", *SETTINGS)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def scene(self, *more, settings=SETTINGS, capture="street"):
        return run(sys.executable, ROOT / "tools/scene/scene.py", self.place / capture, "-o", self.place / "scene.slf",
                   "--parts", 3, "--cores", 2, "--memory", "1G", "--slf", SLF, *more, "--", *settings)

    def test_the_file_is_that_of_one_process_and_a_lost_part_alone_is_made_again(self):
        done = self.scene()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        whole = (self.place / "whole.slf").read_bytes()
        self.assertEqual((self.place / "scene.slf").read_bytes(), whole)
        parts = self.place / "scene.slf.work/parts"
        kept = (parts / "part-1.slf").stat().st_mtime_ns
        (parts / "part-2.slf").unlink()
        again = self.scene()
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
        self.assertEqual((parts / "part-1.slf").stat().st_mtime_ns, kept)
        self.assertEqual((self.place / "scene.slf").read_bytes(), whole)
        other = self.scene(settings=[*SETTINGS, "-q", "30"])
        self.assertEqual(other.returncode, 1)
        self.assertIn("settings", other.stderr)

    def test_a_part_that_fails_is_named_and_the_others_make_a_partial_scene(self):
        # A program that fails in part 2.
        program = self.place / "slf"
        program.write_text(f'#!/bin/sh\ncase "$*" in *"--part 2/3"*) echo "slf: no part 2" >&2; exit 7;; esac\nexec {SLF} "$@"\n')
        program.chmod(0o755)
        failed = self.scene("--slf", program, "--work", self.place / "other", "--retries", 0, "--allow-missing")
        self.assertEqual(failed.returncode, 1)
        self.assertIn("part 2/3: missing", failed.stdout)
        self.assertIn("partial", failed.stdout)
        self.assertEqual(run(SLF, "decode", self.place / "scene.slf", "-o", self.place / "x.ply").returncode, 0)

    def test_a_plan_that_fails_says_why(self):
        none = self.scene("--work", self.place / "none", capture="nowhere")
        self.assertEqual(none.returncode, 1)
        self.assertIn("nowhere", none.stdout)


if __name__ == "__main__":
    if not shutil.which("snakemake"):
        print("skipped: no snakemake (tools/setup.sh lab)")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
