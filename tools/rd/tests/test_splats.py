# SPDX-License-Identifier: Apache-2.0
"""Trained splats: what draws them, what judges, and the script around, with a fake splat-transform."""
import csv
import json
import os
import shutil
import subprocess
import sys
import unittest

import matplotlib.image
import numpy as np

import judge
import splat_render
import splats
from tests.scratch import RD, Scratch

FAKE_PROGRAM = RD / "tests" / "fake_splat_transform.py"
SLF = os.environ.get("SLF_PROGRAM")
CAMERA = {"image": "images/0001.png", "width": 48, "height": 32, "K": [[60, 0, 24], [0, 60, 16], [0, 0, 1]],
          "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "t": [0, 0, 5]}


def grey(level):
    """The first harmonic of a display value 0 .. 1."""
    return (level - 0.5) / splat_render.C0


def one(position=(0, 0, 0), deviation=0.1, opacity=0.5, colours=(1, 0.5, 0)):
    """A round splat of one colour."""
    return splat_render.Splats(np.array([position], float), deviation ** 2 * np.eye(3)[None], np.array([opacity]),
                               np.array([[[grey(c) for c in colours]]]))


def together(*parts):
    return splat_render.Splats(*(np.concatenate([getattr(p, name) for p in parts])
                                 for name in ("positions", "covariances", "opacities", "harmonics")))


def write_splats(path, count=60, degree=1, seed=3):
    """A ball of splats as a PLY of the usual layout."""
    random = np.random.default_rng(seed)
    rest = 3 * ((degree + 1) ** 2 - 1)
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(rest)), "opacity",
             *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
    rows = random.normal(0, 0.3, (count, len(names))).astype("<f4")
    rows[:, names.index("scale_0"):names.index("scale_0") + 3] = np.log(0.15)
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n" + "".join(f"property float {n}\n" for n in names)
    path.write_bytes(header.encode() + b"end_header\n" + rows.tobytes())
    return path


def ball(count=3000, radius=0.5):
    """Points of a sphere, evenly; their normals."""
    k = np.arange(count) + 0.5
    z, azimuth = 1 - 2 * k / count, np.pi * (1 + 5 ** 0.5) * k
    normals = np.stack([np.sqrt(1 - z * z) * np.cos(azimuth), np.sqrt(1 - z * z) * np.sin(azimuth), z], 1)
    return radius * normals, normals


def write_capture(folder, pictures=8):
    """A ball before grey, photographs of the size of CAMERA."""
    (folder / "images").mkdir(parents=True)
    cameras = [{**CAMERA, "image": f"images/{n + 1:04}.png", "t": [0.02 * n, 0, 5]} for n in range(pictures)]
    for camera in cameras:
        matplotlib.image.imsave(folder / camera["image"], np.full((camera["height"], camera["width"], 3), 128, np.uint8))
    (folder / "cameras.json").write_text(json.dumps({"cameras": cameras}))
    rows = np.concatenate(ball(), 1).astype("<f4")
    names = ("x", "y", "z", "nx", "ny", "nz")
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n" + "".join(f"property float {n}\n" for n in names)
    (folder / "points.ply").write_bytes(header.encode() + b"end_header\n" + rows.tobytes())
    return folder


class Drawing(Scratch):
    def test_a_round_splat_is_a_bell_of_its_opacity(self):
        picture, coverage = splat_render.render(one(), {**CAMERA, "K": [[60, 0, 24.5], [0, 60, 16.5], [0, 0, 1]]})
        self.assertAlmostEqual(coverage[16, 24], 0.5, 6)
        variance = (60 * 0.1 / 5) ** 2 + splat_render.BLUR
        self.assertAlmostEqual(coverage[16, 26], 0.5 * np.exp(-4 / (2 * variance)), 5)
        self.assertAlmostEqual(coverage[13, 24], 0.5 * np.exp(-9 / (2 * variance)), 5)
        np.testing.assert_allclose(picture[16, 24], [0.5, 0.25, 0], atol=1e-6)
        self.assertEqual(coverage[0, 0], 0)

    def test_the_nearer_one_hides_whatever_the_order(self):
        near, far = one((0, 0, -1), 0.5, 0.99, (1, 1, 1)), one((0, 0, 1), 0.5, 0.99, (0, 0, 0))
        for parts in ((near, far), (far, near)):
            picture, coverage = splat_render.render(together(*parts), CAMERA)
            self.assertGreater(picture[16, 24, 0], 0.95)
            self.assertGreater(coverage[16, 24], 0.99)

    def test_behind_the_eye_nothing_is_drawn(self):
        picture, coverage = splat_render.render(one((0, 0, -6)), CAMERA)
        self.assertEqual((picture.max(), coverage.max()), (0, 0))

    def test_harmonics_are_orthonormal_over_the_sphere(self):
        _, directions = ball(20_000)
        values = splat_render.harmonic_values(directions, 16)
        np.testing.assert_allclose(4 * np.pi * values.T @ values / len(values), np.eye(16), atol=2e-3)
        signs = np.sign(splat_render.harmonic_values(np.eye(3), 4)[:, 1:])
        np.testing.assert_array_equal(signs, [[0, 0, -1], [-1, 0, 0], [0, 1, 0]])

    def test_a_file_gives_turned_covariances_and_harmonics_by_channel(self):
        path = write_splats(self.folder / "a.ply", 5, 2)
        read, ply = splat_render.read_splats(path), splat_render.read_ply(path)
        self.assertEqual(read.harmonics.shape, (5, 9, 3))
        self.assertEqual(read.harmonics[2, 1, 1], ply["f_rest_8"][2])
        np.testing.assert_allclose(read.covariances, np.tile(0.15 ** 2 * np.eye(3), (5, 1, 1)), atol=1e-7)

    def test_another_ply_is_refused(self):
        write_capture(self.folder / "c")
        with self.assertRaisesRegex(ValueError, "no f_dc_0"):
            splat_render.read_splats(self.folder / "c" / "points.ply")


class Judging(Scratch):
    def test_points_cover_the_disc_that_their_ball_is(self):
        capture = judge.Capture(write_capture(self.folder / "c"))
        self.assertEqual(capture.held_out, ["images/0004.png", "images/0008.png"])
        covered = judge.surface_coverage(capture, CAMERA) >= 0.5
        v, u = np.mgrid[:32, :48] + 0.5
        distance = np.hypot(u - 24, v - 16)
        radius = 60 * 0.5 / np.sqrt(25 - 0.25)
        self.assertTrue(covered[distance < radius - 0.7].all())
        self.assertFalse(covered[distance > radius + 0.7].any())

    def test_errors_are_pooled_over_pixels_and_pictures(self):
        was = np.full((20, 20, 3), 100)
        shown = np.zeros((20, 20), bool)
        shown[:10] = True
        coverage, background = np.full((20, 20), 255), np.array([128, 128, 128])
        whole = judge.Quality()
        for error in (3, 5):
            part = judge.Quality()
            part.add(was, shown, background, was + error * shown[..., None], coverage)
            whole.include(part)
        report = whole.report()
        self.assertAlmostEqual(report["inside"]["psnr"], 10 * np.log10(255 ** 2 / 17))
        self.assertAlmostEqual(report["all"]["psnr"], 10 * np.log10(255 ** 2 / 8.5))
        self.assertEqual(report["coverage"], 1)

    def test_the_background_shows_through_what_is_not_covered(self):
        whole = judge.Quality()
        background = np.array([50, 60, 70])
        whole.add(np.tile(background, (16, 16, 1)), np.ones((16, 16), bool), background, np.zeros((16, 16, 3)), np.zeros((16, 16)))
        self.assertEqual(whole.report()["all"], {"psnr": float("inf"), "ssim": 1})
        self.assertEqual(whole.report()["coverage"], 0)

    def test_captures_that_it_does_not_know_are_refused(self):
        with self.assertRaisesRegex(judge.NotJudged, "no cameras.json"):
            judge.Capture(self.folder)

    @unittest.skipUnless(SLF, "SLF_PROGRAM, the real slf, is not given")
    def test_figures_are_those_of_slf_eval(self):
        place, coded = self.folder / "c", self.folder / "x.slf"

        def slf(*words):
            return subprocess.run([SLF, *map(str, words)], capture_output=True, text=True, check=True).stdout
        slf("synth", "can", "-o", place, "--size", "96x96", "--points", 4000, "--circles", 4, "--per-circle", 6, "--quiet")
        slf("encode", place, "-o", coded, "-q", 32, "--surface", "given", "--quiet")
        expected = json.loads(slf("eval", coded, place, "--json", "--quiet"))["held_out"]["image"]
        capture, quality = judge.Capture(place), judge.Quality()

        def drawn(name, *words):
            slf("render", coded, "--capture", place, "--image", name, "-o", self.folder / "r.png", "--quiet", *words)
            return np.round(255 * matplotlib.image.imread(self.folder / "r.png")).astype(int)
        for name in capture.held_out:
            quality.add(*capture.photograph(name), drawn(name, "--background", "0,0,0")[..., :3], drawn(name, "--transparent")[..., 3])
        report = quality.report()
        self.assertAlmostEqual(report["coverage"], expected["coverage"], 6)
        for mine, its in ((report["inside"], expected), (report["all"], expected["all"])):
            self.assertAlmostEqual(mine["psnr"], its["psnr"], 4)
            self.assertAlmostEqual(mine["ssim"], its["ssim"], 6)


class Script(Scratch):
    def script(self, *words):
        done = subprocess.run([sys.executable, str(RD / "splats.py"), *map(str, words), "--out", str(self.folder / "out")],
                              capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def rows(self):
        with open(self.folder / "out" / "splats.csv", encoding="utf-8") as file:
            return {(row["name"], row["format"]): row for row in csv.DictReader(file)}

    def test_every_file_is_judged_as_floats_and_in_every_format(self):
        place = write_capture(self.folder / "c")
        small, large = write_splats(self.folder / "small.ply", 40), write_splats(self.folder / "large.ply", 90)
        code, said, _ = self.script(place, small, large, "--splat-transform", FAKE_PROGRAM, "--jobs", 2)
        self.assertEqual(code, 0, said)
        rows = self.rows()
        self.assertEqual(len(rows), 6)
        self.assertEqual({row["status"] for row in rows.values()}, {"ok"})
        self.assertEqual(int(rows["small", "float"]["bytes"]), small.stat().st_size)
        self.assertEqual(int(rows["large", "sog"]["bytes"]), (self.folder / "out" / "large.sog").stat().st_size)
        self.assertNotEqual(rows["large", "float"]["psnr"], rows["large", "spz"]["psnr"])
        curve = (self.folder / "out" / "spz.csv").read_text().split()
        self.assertEqual(curve, [f"{rows[n, 'spz']['bytes']},{rows[n, 'spz']['psnr']}" for n in ("small", "large")])

    def test_a_file_that_fails_leaves_its_row_and_the_others_are_judged(self):
        place = write_capture(self.folder / "c")
        good, broken = write_splats(self.folder / "good.ply"), write_splats(self.folder / "broken.ply")
        code, said, _ = self.script(place, good, broken, place / "points.ply", "--splat-transform", FAKE_PROGRAM)
        self.assertEqual(code, 1)
        self.assertIn("failed: fake_splat_transform.py: exit code 1: Error: broken.ply is broken", said)
        rows = self.rows()
        self.assertEqual(rows["broken", "float"]["status"], "ok")
        self.assertEqual(rows["good", "spz"]["status"], "ok")
        self.assertIn("not a PLY of splats", rows["points", "float"]["reason"])

    def test_without_the_program_the_formats_are_skipped_by_name(self):
        place = write_capture(self.folder / "c")
        code, said, told = self.script(place, write_splats(self.folder / "a.ply"), "--splat-transform", self.folder / "none")
        self.assertEqual(code, 0, told)
        self.assertIn("skipped: spz, sog: no program", told)
        self.assertEqual(set(self.rows()), {("a", "float")})

    def test_what_is_wrong_with_the_input_is_told(self):
        path = write_splats(self.folder / "a.ply")
        self.assertEqual(self.script(self.folder, path, "--formats", "")[0], splats.BAD_INPUT)
        code, _, told = self.script(self.folder, path, "--formats", "spz,zip")
        self.assertEqual(code, 2)
        self.assertIn('no format "zip"', told)

    @unittest.skipUnless(shutil.which("node") and (splats.PACKAGE / "node_modules").is_dir(),
                         "node or splat_transform/node_modules is not there (npm ci --prefix tools/rd/splat_transform)")
    def test_the_real_program_gives_the_splats_back_where_they_were(self):
        path = write_splats(self.folder / "a.ply", 300)
        was = splat_render.read_splats(path)
        for format_ in splats.FORMATS:
            decoded, row = splats.code(splats.converter(None), format_, path, self.folder)
            self.assertLess(row["bytes"], path.stat().st_size)
            back = splat_render.read_splats(decoded)
            pictures = [splat_render.render(own, CAMERA)[0] for own in (was, back)]
            self.assertLess(np.abs(pictures[0] - pictures[1]).mean(), 0.01, format_)


if __name__ == "__main__":
    unittest.main()
