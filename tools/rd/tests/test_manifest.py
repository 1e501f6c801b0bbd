# SPDX-License-Identifier: Apache-2.0
"""A manifest that is not sound is refused with its line, before anything runs."""
import json
import pathlib
import unittest

import manifest
import options as opt
from located_json import BadInput, load
from tests.scratch import RD, Scratch

LINES = """{
  "label": "fig:order",
  "title": "Order",
  "figure": "curves",
  "captures": ["synth:can"],
  "grid": {"order": [1, 2]},
  "options": {
    "grid-bits": 7
  },
  "rates": {"raht": [4, 8]}
}
"""


class Lines(Scratch):
    def refuse(self, line, what, text):
        path = self.manifest(text=text)
        with self.assertRaises(BadInput) as caught:
            manifest.read(path, "m.json")
        self.assertRegex(str(caught.exception), f"^m.json:{line}: .*{what}")

    def test_the_text_itself_is_sound(self):
        self.assertEqual(manifest.read(self.manifest(text=LINES))[1]["grid"], {"order": [1, 2]})

    def test_unknown_key(self):
        self.refuse(3, 'unknown key "titel"', LINES.replace('"title"', '"titel"'))

    def test_unknown_option(self):
        self.refuse(8, 'no option "grid-bit"', LINES.replace('"grid-bits"', '"grid-bit"'))

    def test_impossible_parameters(self):
        self.refuse(6, "order 5: a whole number 1 to 4", LINES.replace("[1, 2]", "[1,\n5]").replace("[1,\n5]", "[1, 5]"))
        self.refuse(7, "order 5", LINES.replace("[1, 2]", "[1,\n5]"))
        self.refuse(10, "quality 0 of raht: a number 0.05 to 4096", LINES.replace("[4, 8]", "[4, 0]"))
        for option, value in (("lambda", "-1"), ("functions", "100"), ("delta", "91"), ("order", "2.5"), ("grid-bits", "true"),
                              ("beta", '"1"'), ("iterations", "[3]")):
            self.refuse(8, option, LINES.replace('"grid-bits": 7', f'"{option}": {value}').replace('"order": [1, 2]', '"neighbours": [1, 2]'))

    def test_texture_bits_9(self):
        text = LINES.replace('"raht"', '"tmc"').replace('"rates"', '"codecs": ["tmc"], "rates"')
        self.refuse(8, "texture-bits 9: one of 8, 10, 12", text.replace('"grid-bits": 7', '"texture-bits": 9'))

    def test_an_option_that_no_codec_takes(self):
        self.refuse(8, "none of the codecs raht takes texture-bits", LINES.replace('"grid-bits": 7', '"texture-bits": 8'))

    def test_codec_preset_figure_and_label(self):
        self.refuse(4, 'figure: there is no "curve"', LINES.replace('"curves"', '"curve"'))
        self.refuse(2, "label", LINES.replace('"fig:order"', '"Order"'))
        self.refuse(3, 'codecs: there is no "jpeg"', LINES.replace('"title"', '"codecs": ["jpeg"], "title"'))
        self.refuse(3, 'presets: there is no "best"', LINES.replace('"title"', '"presets": ["best"], "title"'))

    def test_rates_must_fit_the_codecs(self):
        self.refuse(10, "no rates of tmc", LINES.replace('"rates"', '"codecs": ["raht", "tmc"], "rates"'))
        self.refuse(10, 'rates of "tmc"', LINES.replace('"raht"', '"tmc"'))

    def test_twice_and_empty(self):
        self.refuse(6, "1 stands here twice", LINES.replace("[1, 2]", "[1, 1]"))
        self.refuse(6, "the list is empty", LINES.replace("[1, 2]", "[]"))
        self.refuse(4, 'the key "title" stands here twice', LINES.replace('"figure"', '"title": "x", "figure"'))
        self.refuse(8, "grid-bits is in the grid as well", LINES.replace('"order": [1, 2]', '"grid-bits": [6, 7]'))

    def test_missing_keys(self):
        self.refuse(1, 'the key "title" is missing', LINES.replace('  "title": "Order",\n', ""))
        self.refuse(1, 'figure "curves" needs the key "grid"', LINES.replace('  "grid": {"order": [1, 2]},\n', ""))

    def test_not_json(self):
        self.refuse(5, "is expected", LINES.replace('"curves",', '"curves"'))
        self.refuse(11, "after a comma", LINES.replace("[4, 8]}", "[4, 8]},"))
        self.refuse(12, "something follows", LINES + "x")
        self.refuse(1, "not JSON", "")
        self.refuse(1, "an object is expected", "[1]")
        self.refuse(6, "NaN", LINES.replace("[1, 2]", "[NaN]"))
        self.refuse(1, "nested too deeply", "[" * 100000)

    def test_values_agree_with_the_json_module(self):
        for path in sorted(RD.glob("*/*.json")):
            self.assertEqual(load(path).plain(), json.loads(path.read_text(encoding="utf-8")))


class Shipped(unittest.TestCase):
    def test_every_manifest_is_sound_and_the_sets_have_the_papers_labels(self):
        full = {manifest.read(path)[1]["label"] for path in (RD / "experiments").glob("*.json")}
        for label in ("delta_c", "order", "n_basis", "lambda", "beta", "recon_density_can", "recon_density_dice", "spatial_scalability",
                      "fidelity_scalability_nbasis", "fidelity_scalability_qs", "recon_arb_can", "recon_arb_die", "rdcompare_blender_can",
                      "rdcompare_die", "spline", "1dfit", "coef_dist"):
            self.assertIn("fig:" + label, full)
        self.assertIn("tab:time", full)
        quick = [manifest.read(path)[1] for path in (RD / "quick").glob("*.json")]
        self.assertEqual({c for m in quick for c in m["codecs"]}, set(opt.CODECS))


class Refused(Scratch):
    def refuse(self, what, *words):
        code, _, said = self.rd(*words)
        self.assertEqual(code, 2, said)
        self.assertRegex(said, what)
        self.assertEqual(self.called("encode") + self.called("synth"), [])

    def test_missing_captures_have_a_line(self):
        self.refuse(r"m.json:6: capture nowhere/x: nothing is there", self.manifest(captures=["nowhere/x"]))
        self.refuse(r'm.json:6: capture synth:cup: no scene "cup"', self.manifest(captures=["synth:cup"]))
        self.refuse(r"m.json:6: capture synth:can\?size=3: size=3", self.manifest(captures=["synth:can?size=3"]))

    def test_one_bad_manifest_stops_the_good_one(self):
        bad = pathlib.Path(self.manifest("bad.json", grid={"order": [5]}))
        self.refuse("bad.json:[0-9]+: order 5", self.manifest(), bad)

    def test_a_label_twice(self):
        self.refuse("b.json:2: fig:order is also", self.manifest("a.json"), self.manifest("b.json"))

    def test_a_split_that_the_capture_has_not(self):
        code, _, said = self.rd(self.manifest(splits=["thick"], captures=["synth:can"]), "--dry-run")
        self.assertEqual(code, 2)
        self.assertRegex(said, 'm.json:[0-9]+: synth:can: no split "thick"')

    def test_what_the_data_directory_lacks_is_skipped_with_a_note(self):
        code, _, said = self.rd(self.manifest(captures=["synth:can", "data:nothing"]), "--dry-run")
        self.assertEqual(code, 0)
        self.assertIn("skipped: nothing: no data directory", said)
        self.assertIn("16 encodes", said)


if __name__ == "__main__":
    unittest.main()
