# SPDX-License-Identifier: Apache-2.0
"""Variants: what is refused, what they expand to, and the table against the first of them."""
import csv
import unittest

import manifest
import options as opt
import plan as planning
import tables
import verdicts
from located_json import BadInput
from tests.scratch import FAKE, Scratch
from tests.test_verdicts import curve

LINES = """{
  "label": "tab:ablation",
  "title": "Tools",
  "figure": "ablation",
  "captures": ["synth:can"],
  "options": {"order": 2, "linear": true},
  "variants": {
    "all": {},
    "order 3": {"options": {"order": 3}},
    "display values": {"options": {"linear": false}},
    "paper": {"preset": "paper"}
  },
  "presets": ["default"],
  "rates": {"raht": [4, 8, 16, 32]}
}
"""


class Refused(Scratch):
    def refuse(self, line, what, before, after):
        self.assertIn(before, LINES)
        with self.assertRaises(BadInput) as caught:
            manifest.read(self.manifest(text=LINES.replace(before, after)), "m.json")
        self.assertRegex(str(caught.exception), f"^m.json:{line}: .*{what}")

    def test_a_grid_beside_variants(self):
        self.refuse(7, "variants: there is a grid as well", '"variants"', '"grid": {"beta": [0, 1]}, "variants"')

    def test_bad_names_and_values_have_the_line_of_the_variant(self):
        self.refuse(9, 'no option "ordre"', '{"order": 3}', '{"ordre": 3}')
        self.refuse(9, "order 9: a whole number 1 to 4", '{"order": 3}', '{"order": 9}')
        self.refuse(9, "none of the codecs raht takes chroma", '{"order": 3}', '{"chroma": 444}')
        self.refuse(10, "linear 1: true or false is expected", "false", "1")
        self.refuse(11, 'there is no "best"; there are paper, default', '{"preset": "paper"}', '{"preset": "best"}')
        self.refuse(11, 'variant paper: unknown key "rates"', '{"preset": "paper"}', '{"rates": [1]}')
        self.refuse(11, "variant paper: an object is expected", '{"preset": "paper"}', '"paper"')
        self.refuse(8, "a name is empty", '"all"', '""')
        self.refuse(9, 'the key "all" stands here twice', '"order 3"', '"all"')

    def test_a_figure_that_does_not_show_them_and_what_an_ablation_needs(self):
        self.refuse(7, "variants: only the figures curves, deltas, ablation", '"ablation",', '"compare",')
        self.refuse(1, 'figure "ablation" needs the key "variants"', '"variants": {', '"grid": {')

    def test_one_preset_and_two_variants_at_least(self):
        self.refuse(13, "presets: beside variants one is expected", '["default"]', '["default", "paper"]')
        text = LINES[:LINES.index('    "order 3"')].rstrip().rstrip(",") + LINES[LINES.index('\n  },\n  "presets"'):]
        with self.assertRaisesRegex(BadInput, "m.json:7: variants: two or more are expected"):
            manifest.read(self.manifest(text=text), "m.json")


class Expansion(Scratch):
    def test_a_series_per_variant_in_order_whose_options_override(self):
        plan = planning.make([(self.manifest(text=LINES), "m.json")], str(FAKE), self.folder / "out")
        points = plan["experiments"][0]["points"]
        self.assertEqual(len(plan["jobs"]), 16)
        self.assertEqual([p["variant"] for p in points], [name for name in ("all", "order 3", "display values", "paper") for _ in range(4)])
        jobs = [plan["jobs"][p["job"]] for p in points[::4]]
        self.assertEqual([job["options"] for job in jobs],
                         [{"order": 2, "linear": True}, {"order": 3, "linear": True}, {"order": 2}, {"order": 2, "linear": True}])
        self.assertEqual([job["preset"] for job in jobs], ["default", "default", "default", "paper"])

    def test_a_flag_has_no_value_on_the_command_line(self):
        self.assertEqual(opt.words({"linear": True, "order": 3, "dc": "free"}), ["--free-dc", "--linear", "--order", "3"])
        self.assertEqual(opt.words({"linear": False}), [])


class Table(unittest.TestCase):
    def rows(self, name, scale=1.0, seconds=2.0, **more):
        rows = curve("tab:ablation", scale=scale, **more)
        for row in rows:
            row |= {"variant": name, "encode": {"seconds": {"total": seconds}}}
            row["eval"] |= {"bytes": int(row["eval"]["bytes"]), "decode": {"total": seconds / 4}}
        return rows

    def test_every_variant_is_compared_with_the_first_in_the_manifests_order(self):
        header, lines = tables.ablation_table(self.rows("z") + self.rows("a", scale=0.8, seconds=3))
        self.assertEqual([line[3] for line in lines], ["z", "a"])
        self.assertEqual(lines[0][4:], ["–", "–", "8", "4,000", "34.00", "2.000", "1.00", "0.500", "1.00"])
        self.assertEqual(lines[1][4:], ["-20.0 %", "-20.0 %", "8", "3,200", "34.00", "3.000", "1.50", "0.750", "1.50"])
        self.assertEqual({len(line) for line in lines}, {len(header)})

    def test_pictures_have_columns_of_their_own_where_they_were_measured(self):
        rows = self.rows("z") + self.rows("a", scale=0.8)
        for row in rows:
            for cameras in ("held_out", "input"):
                row["eval"][cameras]["image"] = {"psnr": row["eval"][cameras]["points"][0]["psnr"] - 3}
        header, lines = tables.ablation_table(rows)
        self.assertEqual({len(line) for line in lines}, {len(header)})
        at = {name: lines[1][i] for i, name in enumerate(header)}
        self.assertEqual((at["images: BD-rate, held out"], at["images: BD-rate, input"]), ("-20.0 %", "-20.0 %"))
        self.assertEqual((at["held out dB"], at["image dB"]), ("34.00", "31.00"))

    def test_each_capture_and_split_has_its_own_first(self):
        rows = [row for split, scale in (("dense", 1), ("sparse", 2)) for name, factor in (("all", 1), ("none", 1.5))
                for row in self.rows(name, scale=scale * factor, split=split)]
        self.assertEqual([(line[1], line[4]) for line in tables.ablation_table(rows)[1]],
                         [("dense", "–"), ("dense", "+50.0 %"), ("sparse", "–"), ("sparse", "+50.0 %")])

    def test_failed_encodes_leave_a_reason_and_times_of_the_rates_in_common(self):
        first, second = self.rows("all"), self.rows("none", seconds=3)
        for row in second[1:3]:
            row |= {"status": "failed", "encode": {}, "eval": {}}
        line = tables.ablation_table(first + second)[1][1]
        self.assertEqual(line[4], "none: the test has 2 points, 4 are needed")
        self.assertEqual(line[6:], ["8", "–", "–", "3.000", "1.50", "0.750", "1.50"])
        for row in second:
            row |= {"status": "failed", "encode": {}, "eval": {}}
        self.assertEqual(tables.ablation_table(first + second)[1][1][7:], ["–"] * 6)

    def test_verdicts_and_bd_figures_against_igc_leave_variants_out(self):
        rows = [r for o in (1, 2, 3, 4) for r in curve("fig:order", lift=0.5 * (o == 2), order=o)]
        variants = [r | {"variant": "v", "experiment": name} for name in ("fig:order_v", "fig:rdcompare_v")
                    for r in curve(name, lift=9, codec="igc-hevc", order=3) + curve(name, order=3)]
        self.assertEqual(verdicts.judge(rows + variants), verdicts.judge(rows))
        self.assertEqual(tables.bd_table(variants)[1], [])


class Geometry(unittest.TestCase):
    def test_bd_rate_without_geometry_is_that_of_the_other_bytes(self):
        rows = curve("fig:rdcompare_x", codec="igc-hevc") + curve("fig:rdcompare_x", scale=0.5)
        for row, geometry in zip(rows, [500] * 4 + [100] * 4):
            row["eval"]["bytes"] += geometry
            row["eval"]["bytes_by_type"] = {"geometry": geometry}
        header, (line,) = tables.bd_table(rows)
        cells = dict(zip(header, line))
        self.assertEqual(cells["BD-rate without geometry, held out"], "-50.0 % (-50.0)")
        self.assertNotEqual(cells["BD-rate, held out"], "-50.0 % (-50.0)")

    def test_curves_of_two_experiments_stay_apart(self):
        rows = [r for name, scale in (("fig:rdcompare_a", 0.5), ("fig:rdcompare_b", 0.8))
                for r in curve(name, codec="igc-hevc") + curve(name, scale=scale)]
        self.assertEqual([(line[0], line[5]) for line in tables.bd_table(rows)[1]],
                         [("fig:rdcompare_a", "-50.0 % (-50.0)"), ("fig:rdcompare_b", "-20.0 % (-20.0)")])


class Run(Scratch):
    def test_table_report_and_markdown_have_the_variants(self):
        code, _, said = self.rd(self.manifest(text=LINES), "--markdown", self.folder / "md")
        self.assertEqual(code, 0, said)
        self.assertEqual(sum("--linear" in call for call in self.called("encode")), 12)
        with open(self.folder / "out" / "results.csv", newline="", encoding="utf-8") as file:
            self.assertEqual([row["variant"] for row in csv.DictReader(file)][::4], ["all", "order 3", "display values", "paper"])
        page = (self.folder / "md" / "README.md").read_text(encoding="utf-8")
        self.assertLess(page.index("| dense | SLF-RAHT | all | – | – | 8 |"), page.index("| dense | SLF-RAHT | order 3 | "))
        report = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("<td>order 3</td>", report)
        self.assertIn(tables.ABLATION_NOTE[:40], report)


if __name__ == "__main__":
    unittest.main()
