# SPDX-License-Identifier: Apache-2.0
"""Scripts of tools/captures, run by Blender."""
import shutil
import subprocess
import unittest

from tests.scratch import RD

needed = unittest.skipUnless(shutil.which("blender"), "blender is not there")


def run(script, *words):
    return subprocess.run(["blender", "-b", "--factory-startup", "-P", str(RD.parent / "captures" / script), "--", *map(str, words)],
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
