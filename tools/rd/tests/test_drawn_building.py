# SPDX-License-Identifier: Apache-2.0
"""tools/captures/draw_building.py, where Blender is: small captures whose points lie before their cameras, under a sky."""
import json
import unittest

import numpy as np
from PIL import Image

from tests import blender
from tests.scratch import Scratch
from tmc3 import read_ply


@blender.needed
class DrawnBuilding(Scratch):
    def test_cameras_see_the_building_below_and_the_sky_above(self):
        for scene, held_out in (("castle", 3), ("temple", 5)):
            out = self.folder / scene
            done = blender.run("draw_building.py", out, scene, "--width", 48, "--samples", 1, "--points", 4000)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            capture = json.loads((out / "cameras.json").read_text())
            self.assertEqual(len(capture["splits"]["evaluation"]), held_out)
            points = read_ply(out / "points.ply")
            places = np.stack([points[axis] for axis in "xyz"], 1)
            for row in capture["cameras"]:
                at = places @ np.array(row["R"]).T + row["t"]
                u = row["K"][0][0] * at[:, :2] / at[:, 2:] + [row["width"] / 2, row["height"] / 2]
                shown = (at[:, 2] > 0) & (abs(u - [24, 16]) < [24, 16]).all(1)
                self.assertGreater(shown.mean(), 0.3, row["image"])
                picture = np.asarray(Image.open(out / row["image"]).convert("RGB"), float)
                blue = picture[..., 2] - picture[..., 0]
                self.assertGreater(blue[0].mean(), blue[-1].mean(), row["image"])
            self.assertEqual(len(read_ply(out / "sparse_points.ply")["x"]), min(3500, len(places)))

    def test_a_scene_that_is_none_is_refused(self):
        done = blender.run("draw_building.py", self.folder / "none", "hut")
        self.assertEqual(done.returncode, 2)
        self.assertIn("hut", done.stderr)
        self.assertFalse((self.folder / "none").exists())


if __name__ == "__main__":
    unittest.main()
