# SPDX-License-Identifier: Apache-2.0
"""The codecs of tools/rd/related: what each promises by itself. A ball is drawn, planes are rounded by no program."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "related"))
import curves  # noqa: E402
from chen import Chen, nmf_terms, pca_terms  # noqa: E402
from directions import Lumisphere, filled_maps, hemisphere_to_square, local, looked_up, map_corners, push_pull, tangent_frames  # noqa: E402
from entropy import bits_of, index_bits  # noqa: E402
from miller import Miller, transform  # noqa: E402
from multiview import Multiview, walk  # noqa: E402
from observations import Scene  # noqa: E402
from planes import Packer  # noqa: E402
from tests.drawn_sphere import Rounder, camera, write_capture  # noqa: E402
from views import RahtKlt, Volino  # noqa: E402
from wood import Principal, Quantised  # noqa: E402

RANDOM = np.random.default_rng(5)


def directions(count, hemisphere=False):
    d = RANDOM.normal(size=(count, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return np.where(d[:, 2:] < 0, -d, d) if hemisphere else d


class Drawn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.holder.cleanup)
        cls.folder = pathlib.Path(cls.holder.name)
        cls.positions, origin, step = write_capture(cls.folder)
        cls.scene = Scene(cls.folder, cls.positions, origin, step)

    def psnr(self, codec, *setting):
        size, colours = codec.coded(*setting)
        return size, self.scene.fitted.psnr(colours(self.scene.fitted)), self.scene.held_out.psnr(colours(self.scene.held_out))

    def assert_monotone(self, codec, settings):
        coded = [self.psnr(codec, *s) for s in settings]
        sizes, fitted = [c[0] for c in coded], [c[1] for c in coded]
        self.assertEqual(sizes, sorted(sizes, reverse=True), codec)
        self.assertEqual(fitted, sorted(fitted, reverse=True), codec)
        self.assertLess(sizes[-1], sizes[0])


class ObservationsTest(Drawn):
    def test_a_point_is_seen_by_cameras_in_front_of_it_alone(self):
        seen = self.scene.fitted
        cosine = (seen.direction * self.scene.normals[seen.point]).sum(1)
        self.assertGreater(cosine.min(), np.sin(np.radians(10)) - 1e-6)
        self.assertGreater(len(seen), 3 * len(self.positions))

    def test_the_colour_is_that_of_the_place_in_the_picture(self):
        seen = self.scene.fitted
        again = seen.with_colours({c: self.scene.cameras[c].photograph() for c in self.scene.fitted_cameras})
        np.testing.assert_allclose(again.colour, seen.colour, atol=1e-3)

    def test_every_fourth_camera_is_held_out(self):
        self.assertEqual(self.scene.held_out_cameras, [3, 7, 11, 15, 19, 23, 27])
        self.assertFalse(set(self.scene.held_out_cameras) & set(np.unique(self.scene.fitted.camera)))

    def test_psnr_is_of_rounded_colours(self):
        seen = self.scene.fitted
        self.assertEqual(seen.psnr(np.floor(seen.colour + 0.5) + 0.4), seen.psnr(seen.colour))
        self.assertAlmostEqual(seen.psnr(np.floor(seen.colour + 0.5) + 5), 20 * np.log10(255 / 5), 5)


class DirectionsTest(unittest.TestCase):
    def test_the_square_has_equal_areas(self):
        at = (hemisphere_to_square(directions(40000, True)) * 4).astype(int).clip(0, 3)
        counts = np.bincount(at[:, 0] * 4 + at[:, 1], minlength=16)
        self.assertLess(np.abs(counts / 2500 - 1).max(), 0.1)

    def test_a_map_that_is_linear_on_the_square_is_looked_up_exactly_inside(self):
        d = directions(2000, True)
        at = hemisphere_to_square(d)
        inside = ((at > 1 / 16) & (at < 15 / 16)).all(1)
        y, x = (np.mgrid[:8, :8] + 0.5) / 8
        maps = np.stack([x, y, 2 * x - y], 2).reshape(1, 64, 3).astype(np.float32)
        got = looked_up(maps, np.zeros(len(d), int), map_corners(d, 8))
        want = np.stack([at[:, 0], at[:, 1], 2 * at[:, 0] - at[:, 1]], 1)
        np.testing.assert_allclose(got[inside], want[inside], atol=1e-5)

    def test_holes_take_the_colour_of_the_level_above(self):
        weight, sums = np.zeros((1, 4, 4, 1), np.float32), np.zeros((1, 4, 4, 3), np.float32)
        weight[0, 0, 0], sums[0, 0, 0] = 2, 20
        weight[0, 3, 3], sums[0, 3, 3] = 1, 30
        out = push_pull(sums, weight)[0, :, :, 0]
        self.assertEqual((out[0, 0], out[1, 1], out[3, 3], out[2, 2], out[0, 3]), (10, 10, 30, 30, 20))

    def test_the_lumisphere_has_258_directions_and_interpolates_between_them(self):
        sphere = Lumisphere()
        self.assertEqual(len(sphere.vertices), 258)
        d = directions(5000)
        vertices, shares = sphere.corners(d)
        np.testing.assert_allclose(shares.sum(1), 1, atol=1e-5)
        near = (sphere.vertices[vertices] * shares[..., None]).sum(1)
        self.assertGreater(((near / np.linalg.norm(near, axis=1, keepdims=True)) * d).sum(1).min(), np.cos(np.radians(0.5)))
        own, share = sphere.corners(sphere.vertices)
        np.testing.assert_array_equal(np.take_along_axis(own, share.argmax(1)[:, None], 1)[:, 0], np.arange(258))

    def test_corners_that_have_four_neighbours_are_six(self):
        self.assertEqual(np.bincount(Lumisphere().degree)[[4, 6]].tolist(), [6, 252])


class EntropyTest(unittest.TestCase):
    def test_length_is_near_the_entropy_of_the_source(self):
        values = RANDOM.geometric(0.5, 50000) - 1          # 2 bits each, and a sign where not 0
        self.assertAlmostEqual(bits_of(values, np.zeros(50000, int)) / 50000, 2.5, delta=0.02)

    def test_contexts_that_tell_pay(self):
        kind = RANDOM.integers(0, 2, 20000)
        values = kind * RANDOM.integers(5, 9, 20000)
        self.assertLess(bits_of(values, kind), 0.8 * bits_of(values, 0 * kind))

    def test_large_magnitudes_are_counted(self):
        self.assertGreater(bits_of(np.array([1 << 20]), np.zeros(1, int)), 40)

    def test_an_index_that_repeats_costs_little_and_a_random_one_its_bits(self):
        before = np.zeros((4096, 2), int)
        self.assertLess(index_bits(np.zeros(4096, int), before, 256), 30)
        self.assertGreater(index_bits(RANDOM.integers(0, 256, 4096), RANDOM.integers(0, 256, (4096, 2)), 256), 7.9 * 4096)


class TransformsTest(unittest.TestCase):
    def test_blocks_of_dct_come_back(self):
        maps = RANDOM.normal(size=(5, 256, 3)).astype(np.float32)
        there = transform(maps, 16)
        self.assertAlmostEqual((there ** 2).sum() / (maps ** 2).sum(), 1, 5)
        np.testing.assert_allclose(transform(there, 16, inverse=True), maps, atol=1e-5)

    def test_factors_of_the_full_rank_are_the_matrix(self):
        matrix = RANDOM.uniform(0, 255, (6, 9))
        u, v = pca_terms(matrix, 6)
        np.testing.assert_allclose(u @ v, matrix, atol=1e-8)

    def test_non_negative_factors_of_a_non_negative_product_approach_it(self):
        matrix = RANDOM.uniform(0, 10, (20, 2)) @ RANDOM.uniform(0, 10, (2, 30))
        u, v = nmf_terms(matrix, 2)
        self.assertGreaterEqual(min(u.min(), v.min()), 0)
        self.assertLess(np.linalg.norm(u @ v - matrix), 0.1 * np.linalg.norm(matrix))

    def test_a_walk_visits_every_camera_and_predicts_from_earlier_ones(self):
        cameras = [type("C", (), {"centre": camera(i, 9)[2]}) for i in range(9)]
        order, near = walk(cameras, np.zeros(3))
        self.assertEqual(sorted(order), list(range(9)))
        for i, some in enumerate(near):
            self.assertLessEqual(set(some), set(order[:i]))


class CodecsTest(Drawn):
    def test_millers_maps_come_back_at_zero_step(self):
        codec = Miller(self.scene, Rounder(), 8)
        plain = looked_up(self.looked_up_maps(8), self.scene.fitted.point, codec.corners[self.scene.fitted])
        np.testing.assert_allclose(codec.coded(0)[1](self.scene.fitted), plain, atol=0.1)

    def looked_up_maps(self, side):
        frames = tangent_frames(self.scene.normals)
        return filled_maps(len(self.positions), self.scene.fitted, local(frames, self.scene.fitted), side)

    def test_chens_factors_come_back_at_zero_step_and_more_terms_are_better(self):
        fitted = [self.psnr(Chen(self.scene, Rounder(), "pca", 8), 0, k)[1] for k in (1, 3, 5)]
        self.assertEqual(fitted, sorted(fitted))
        each_point = Chen(self.scene, Rounder(), "pca", 1)   # a matrix of one row has one term
        plain = looked_up(self.looked_up_maps(16), self.scene.fitted.point, each_point.corners[self.scene.fitted])
        np.testing.assert_allclose(each_point.coded(0, 1)[1](self.scene.fitted), plain, atol=0.2)

    def test_raht_klt_gives_every_observation_back_at_zero_step(self):
        self.assertGreater(self.psnr(RahtKlt(self.scene, Rounder()), 0)[1], 50)

    def test_a_layer_gives_back_the_colours_of_its_camera_at_zero_step(self):
        codec = Volino(self.scene, Rounder(), "frontal")
        colours = codec.coded(0, 3)[1](self.scene.fitted)
        seen, numbers = self.scene.fitted, np.array(self.scene.fitted_cameras)
        first = numbers[codec.best[:, 0]][seen.point] == seen.camera
        self.assertGreater(first.sum(), 100)
        np.testing.assert_allclose(colours[first], seen.colour[first], atol=1)

    def test_photographs_come_back_at_a_fine_step_and_are_predicted(self):
        codec = Multiview(self.scene)
        self.assertGreater(self.psnr(codec, 0.5, 8)[1], 50)
        intra = Multiview(self.scene)
        intra.near = [[] for _ in intra.near]
        self.assertLess(self.psnr(codec, 32, 8)[0], self.psnr(intra, 32, 8)[0])

    def test_wood_reproduces_what_its_functions_span(self):
        self.assertGreater(self.psnr(Principal(self.scene, Rounder()), 1, 6)[1], self.psnr(Principal(self.scene, Rounder()), 1, 1)[1])
        self.assertGreater(self.psnr(Quantised(self.scene, Rounder()), 2, 64)[1], self.psnr(Quantised(self.scene, Rounder()), 2, 2)[1])

    def test_a_larger_step_has_fewer_bytes_and_more_error(self):
        self.assert_monotone(Miller(self.scene, Rounder(), 8), [(8,), (32,), (128,)])
        self.assert_monotone(Miller(self.scene, Rounder(), 16, True), [(8,), (32,), (128,)])
        self.assert_monotone(Chen(self.scene, Rounder(), "pca", 8), [(8, 3), (32, 3), (128, 3)])
        self.assert_monotone(Chen(self.scene, Rounder(), "nmf", 8), [(8, 1), (32, 1), (128, 1)])
        self.assert_monotone(RahtKlt(self.scene, Rounder()), [(8,), (32,), (128,)])
        self.assert_monotone(Volino(self.scene, Rounder(), "spread"), [(8, 3), (32, 3), (128, 3)])
        self.assert_monotone(Principal(self.scene, Rounder()), [(8, 3), (32, 3), (128, 3)])
        self.assert_monotone(Multiview(self.scene), [(8, 8), (32, 8), (128, 8)])


class CurvesTest(unittest.TestCase):
    def test_settings_that_others_beat_are_left_out(self):
        rows = [{"bytes": b, "held_out": q} for b, q in ((100, 20), (90, 21), (200, 20.5), (300, 25))]
        self.assertEqual(curves.front(rows, "held_out"), [(90, 21), (300, 25)])

    def test_half_of_the_bytes_is_minus_fifty_percent(self):
        anchor = [(1000 * 2 ** i, 20 + 2 * i) for i in range(4)]
        self.assertEqual(curves.figure_text(anchor, [(b / 2, q) for b, q in anchor]), "-50 %")

    def test_without_a_bd_rate_the_text_says_what_can_be_compared(self):
        anchor = [(1000 * 2 ** i, 20 + 2 * i) for i in range(4)]
        self.assertEqual(curves.figure_text(anchor, [(10, 12), (100, 15)]), "15.0 dB at 100 B; ours from 20.0 dB at 1 kB")
        self.assertEqual(curves.figure_text(anchor, [(9000, 22), (90000, 29)]), "22.0 dB: 9 kB, ours 2 kB")
        self.assertEqual(curves.figure_text(anchor, [(9000, 27), (90000, 29)]), "27.0 dB at 9 kB; ours to 26.0 dB at 8 kB")


@unittest.skipUnless(os.environ.get("SLF_PROGRAM"), "SLF_PROGRAM names no slf")
class WithTheProgram(Drawn):
    def test_observations_are_those_of_slf_eval(self):
        slf, coded = os.environ["SLF_PROGRAM"], self.folder / "x.slf"
        subprocess.run([slf, "encode", self.folder, "-o", coded, "--grid-bits", "4", "--preset", "paper", "--functions", "1", "--quiet"], check=True)
        done = subprocess.run([slf, "eval", coded, self.folder, "--no-images", "--json", "--quiet"], check=True, capture_output=True)
        subprocess.run([slf, "decode", coded, "--dump", self.folder / "dump", "--quiet"], check=True)
        grid = json.loads((self.folder / "dump" / "light_field.json").read_text(encoding="utf-8"))["grid"]
        scene = Scene(self.folder, np.load(self.folder / "dump" / "positions.npy"), grid["origin"], grid["step"])
        quality = json.loads(done.stdout)
        for name, seen in (("input", scene.fitted), ("held_out", scene.held_out)):
            self.assertEqual(quality[name]["points"][0]["observations"], len(seen))

    def test_planes_come_back_in_the_order_of_the_points(self):
        shuffled = RANDOM.permutation(self.positions)
        planes = RANDOM.uniform(0, 255, (len(shuffled), 2, 3))
        size, decoded = Packer(os.environ["SLF_PROGRAM"], shuffled).pack(planes, 0)
        self.assertLess(abs(decoded - planes).max(), 0.2)
        self.assertGreater(size, len(shuffled))


if __name__ == "__main__":
    unittest.main()
