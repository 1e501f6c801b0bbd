# SPDX-License-Identifier: Apache-2.0
"""Keys, resuming, failing jobs and the table, with a fake slf; one smoke test with the real one."""
import csv
import os
import shutil
import unittest

import plan as planning
from tests.scratch import FAKE, Scratch


class Keys(Scratch):
    def plan(self, *manifests):
        return planning.make([(path, path.name) for path in manifests], str(FAKE), self.folder / "out")

    def test_the_same_job_asked_for_twice_is_one_job(self):
        lam = self.manifest("b.json", label="fig:lambda", grid={"lambda": [0.8, 3]})
        self.assertEqual(len(self.plan(self.manifest("a.json"), lam)["jobs"]), 16 + 8)
        same = self.manifest("b.json", label="fig:other", title="Other", grid={"order": [2]})
        both = self.plan(self.manifest("a.json"), same)
        self.assertEqual(len(both["jobs"]), 16)
        self.assertEqual(len(both["experiments"][1]["points"]), 4)

    def test_measuring_images_somewhere_measures_them_everywhere_once(self):
        with_images = self.manifest("b.json", label="fig:other", grid={"order": [2]}, images=True)
        plan = self.plan(self.manifest("a.json"), with_images)
        self.assertEqual(len(plan["jobs"]), 16)
        self.assertEqual(sum(job["images"] for job in plan["jobs"].values()), 4)

    def test_what_changes_a_result_changes_the_key(self):
        def key(job, programs):
            return planning.job_key({**base, **job}, {**{"slf": "a", "tmc3": "t"}, **programs})
        base = {"codec": "raht", "preset": "paper", "options": {"order": 2}, "rate": 8, "slf_split": "dense", "deltas": [10],
                "images": False, "capture": {"directory": "/x", "points": None, "hash": "h"}}
        first = key({}, {})
        self.assertEqual(first, key({"capture": {"directory": "/moved", "points": None, "hash": "h"}}, {}))
        self.assertEqual(first, key({}, {"tmc3": "another"}))
        changes = [({"rate": 9}, {}), ({"options": {"order": 3}}, {}), ({"preset": "default"}, {}), ({"slf_split": "sparse"}, {}),
                   ({"deltas": [0, 10]}, {}), ({"images": True}, {}), ({}, {"slf": "b"}),
                   ({"capture": {"directory": "/x", "points": None, "hash": "i"}}, {})]
        keys = [key(*change) for change in changes]
        self.assertEqual(len({first, *keys}), 1 + len(changes))

    def test_fractions_stand_in_for_splits_that_a_capture_does_not_name(self):
        named = {"splits": ["dense", "evaluation"]}
        self.assertEqual(planning.cap.split_of(named, "dense"), "dense")
        self.assertEqual(planning.cap.split_of({"splits": None}, "sparse"), "1/8")
        self.assertEqual(planning.cap.split_of(named, "1/4"), "1/4")
        with self.assertRaises(ValueError):
            planning.cap.split_of(named, "sparse")


@unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
class Runs(Scratch):
    def table(self):
        with open(self.folder / "out" / "results.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_second_run_reruns_nothing_and_a_changed_setting_only_itself(self):
        self.assertEqual(self.rd(self.manifest())[0], 0)
        self.assertEqual(len(self.called("encode")), 16)
        self.assertEqual(self.rd(self.manifest())[0], 0)
        self.assertEqual(self.called("encode"), [])
        self.assertEqual(self.rd(self.manifest(grid={"order": [2, 3]}, rates={"raht": [4, 8, 16, 31]}))[0], 0)
        self.assertEqual(len(self.called("encode")), 2)

    def test_a_job_taken_away_is_made_again(self):
        self.rd(self.manifest())
        self.called("encode")
        next((self.folder / "out" / "jobs").glob("*/row.json")).unlink()  # as after an interruption
        self.assertEqual(self.rd(self.manifest())[0], 0)
        self.assertEqual(len(self.called("encode")), 1)

    def test_a_failing_job_leaves_row_and_log_and_the_others_their_results(self):
        code, _, said = self.rd(self.manifest(grid={"lambda": [0.8, 99]}, rates={"raht": [4, 8]}))
        self.assertEqual(code, 1)
        self.assertIn("2 failed: fake_slf.py encode: exit code 1: slf: lambda 99 is what this one fails at", said)
        rows = self.table()
        self.assertEqual([r["status"] for r in rows], ["ok", "ok", "failed", "failed"])
        log = self.folder / "out" / "jobs" / rows[2]["key"] / "log.txt"
        self.assertIn("lambda 99", log.read_text())
        self.assertTrue((self.folder / "out" / "report.html").exists())
        self.called("encode")
        self.assertEqual(self.rd(self.manifest(grid={"lambda": [0.8, 99]}, rates={"raht": [4, 8]}))[0], 1)
        self.assertEqual(len(self.called("encode")), 2, "what failed is tried again")

    def test_the_table_has_a_row_per_encode_with_everything_in_it(self):
        self.rd(self.manifest(codecs=["raht", "igc-hevc"], rates={"raht": [8], "igc-hevc": [30]}, grid={"order": [2]}, images=True))
        raht, igc = self.table()
        self.assertEqual((raht["codec"], raht["set.order"], raht["set.quality"]), ("raht", "2", "8"))
        self.assertEqual((igc["codec"], igc["set.qp"], igc["decode_s.fit"]), ("igc-hevc", "30", "3.0"))
        for name in ("experiment", "capture", "split", "preset", "rate", "input_hash", "commit", "program", "points", "cameras", "bytes",
                     "bytes.geometry", "held_out.psnr.0", "held_out.psnr.30", "held_out.luma_psnr.10", "input.psnr.10",
                     "held_out.image_ssim", "held_out.image_ms_ssim", "held_out.image_coverage", "held_out.image_all_psnr",
                     "input.image_regions_rim_error_share", "encode_s.total", "decode_s.total", "peak_memory_mib"):
            self.assertNotEqual(raht[name], "", name)

    def test_the_report_is_one_page_without_references_and_svgs_are_reproducible(self):
        self.rd(self.manifest())
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("data:image/png;base64,", page)
        self.assertNotRegex(page, r"(src|href)=.?(?!data:)[\"'](?!data:)(https?:|/|[a-z]+/)")
        self.assertNotIn("<script", page)
        svg = self.folder / "out" / "figures" / "fig_order.svg"
        first = svg.read_bytes()
        self.rd(self.manifest())
        self.assertEqual(svg.read_bytes(), first)

    @unittest.skipUnless(os.environ.get("SLF_PROGRAM"), "SLF_PROGRAM, the real slf, is not given")
    def test_smoke_with_the_real_program(self):
        code, _, said = self.rd(self.manifest(captures=["synth:can?size=64&points=1500"], rates={"raht": [8, 32]},
                                              grid={"order": [2]}, options={"grid-bits": 6}),
                                slf=os.environ["SLF_PROGRAM"])
        self.assertEqual(code, 0, said)
        fine, coarse = self.table()
        self.assertGreater(int(fine["bytes"]), int(coarse["bytes"]))
        self.assertGreater(float(fine["input.psnr.10"]), float(coarse["input.psnr.10"]))


if __name__ == "__main__":
    unittest.main()
