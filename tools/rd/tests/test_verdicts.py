# SPDX-License-Identifier: Apache-2.0
"""Every rule on made-up rows: agreeing, contradicting, undecided; and a verdict that flips."""
import unittest

import verdicts
from verdicts import AGREES, CONTRADICTS, UNDECIDED


def row(experiment, bytes_, held_out, rate=8, capture="can", split="dense", codec="raht", inputs=None, **grid):
    points = [{"delta": 10, "psnr": held_out}] if not isinstance(held_out, dict) else [{"delta": d, "psnr": v} for d, v in held_out.items()]
    points_in = [{"delta": 10, "psnr": inputs if inputs is not None else points[0]["psnr"]}]
    return {"experiment": experiment, "capture": capture, "split": split, "codec": codec, "preset": "paper", "variant": None, "grid": grid, "rate": rate,
            "status": "ok", "encode": {}, "eval": {"bytes": bytes_, "held_out": {"points": points}, "input": {"points": points_in}}}


def curve(experiment, scale=1.0, lift=0.0, **more):
    """Four points, 2 dB per doubling of the rate."""
    return [row(experiment, scale * 1000 * 2 ** i, 30 + 2 * i + lift, rate=32 >> i, **more) for i in range(4)]


def verdict(rows, name):
    return verdicts.judge(rows)[name]


class Rules(unittest.TestCase):
    def expect(self, name, word, rows):
        found = verdict(rows, name)
        self.assertEqual(found["verdict"], word, found["figure"])
        return found["figure"]

    def test_order(self):
        def rows(best):
            return [r for o in (1, 2, 3, 4) for r in curve("fig:order", lift=0.5 if o == best else 0, order=o)]
        self.assertIn("+0.50 dB", self.expect("order", AGREES, rows(2)))
        self.expect("order", CONTRADICTS, rows(3))
        self.expect("order", UNDECIDED, [r for r in rows(2) if r["grid"]["order"] != 4])
        self.expect("order", UNDECIDED, rows(0))  # all equal

    def test_lambda(self):
        def rows(gap):
            return [r for v in (1e-6, 0.1, 0.8) for r in curve("fig:lambda", lift=gap * (v > 0.01), **{"lambda": v})]
        self.expect("lambda", AGREES, rows(3))
        self.expect("lambda", UNDECIDED, rows(0.5))
        self.expect("lambda", CONTRADICTS, rows(-0.5))

    def test_delta(self):
        def rows(gap):
            return [row("fig:delta_c", 1000 * 2 ** i, {0: 30 + i + (gap if d == 0 else 0), 10: 31.0 + i}, rate=32 >> i, delta=d)
                    for d in (0, 10, 20) for i in range(4)]
        self.expect("delta", AGREES, rows(0.05))
        self.assertIn("δ′ = 0: 0.30 dB behind δ = 0", self.expect("delta", CONTRADICTS, rows(0.3)))

    def test_functions(self):
        def rows(last):
            return [r for n, lift in ((32, -1), (128, 0), (512, last)) for r in curve("fig:n_basis", lift=lift, functions=n)]
        self.expect("functions", AGREES, rows(0.05))
        self.assertIn("it falls", self.expect("functions", CONTRADICTS, rows(-1)))
        self.expect("functions", CONTRADICTS, rows(1))

    def test_beta(self):
        def rows(scale, lift):
            return curve("fig:beta", beta=0) + curve("fig:beta", scale=scale, lift=lift, beta=1.3)
        self.expect("beta", AGREES, rows(0.8, 0))
        self.expect("beta", CONTRADICTS, rows(0.8, -0.2))
        self.expect("beta", CONTRADICTS, rows(1.1, 0))

    def test_density(self):
        def rows(die):
            return [r for name, drop in (("can", 1), ("die", die)) for split, lift in (("dense", 0), ("sparse", -drop))
                    for r in curve(f"fig:rdcompare_{name}", lift=lift, capture=name, split=split)]
        self.expect("density", AGREES, rows(3))
        self.expect("density", CONTRADICTS, rows(0.5))
        self.expect("density", UNDECIDED, rows(1.05))

    def compare(self, tmc, raht=1.0, lift=0.0, sparse=None):
        rows = []
        for split, scale in (("dense", tmc), ("sparse", tmc if sparse is None else sparse)):
            rows += curve("fig:rdcompare_can", split=split, codec="igc-hevc")
            rows += curve("fig:rdcompare_can", scale=scale, lift=lift, split=split, codec="tmc")
            rows += curve("fig:rdcompare_can", scale=raht, split=split, codec="raht")
        return rows

    def test_tmc_against_raht_by_bd_rate(self):
        self.assertIn("BD-rate -20.0 %", self.expect("tmc", AGREES, self.compare(0.8)))
        self.expect("tmc", CONTRADICTS, self.compare(1.3))
        self.assertIn("1 of 2 cases agree, 1 contradict", self.expect("tmc", UNDECIDED, self.compare(0.8, sparse=1.3)))

    def test_slf_against_igc(self):
        self.assertIn("SLF-RAHT contradicts", self.expect("igc", AGREES, self.compare(0.8, raht=1.5)))
        self.expect("igc", UNDECIDED, [r for r in self.compare(0.8) if r["codec"] != "tmc"])

    def test_without_overlap_there_is_no_bd_figure_but_a_reason(self):
        self.assertIn("dB at the rates in common (no BD-rate", self.expect("igc", CONTRADICTS, self.compare(1, lift=-9)))
        self.assertIn("no rate in common", self.expect("igc", AGREES, self.compare(0.01, lift=10)))

    def test_where_held_out_is_flat_the_input_set_is_compared(self):
        rows = self.compare(0.8)
        for r in rows:  # scaled to a span of 0.06 dB, in which TMC would need more
            p = r["eval"]["held_out"]["points"][0]
            p["psnr"] = 14 + p["psnr"] / 100 - (r["codec"] == "tmc") * 0.1
        self.assertIn("BD-rate -20.0 % on the input set (held out is flat)", self.expect("tmc", AGREES, rows))

    def test_times_are_printed_not_judged(self):
        rows = [row("tab:time", 1000, 30, codec=c) for c in ("raht", "igc-hevc")]
        for r, t in zip(rows, (9.0, 1.0)):
            r["eval"]["decode"] = {"total": t}
        self.assertEqual(verdict(rows, "time")["verdict"], "printed")
        self.assertIn("raht 9.00 s, igc-hevc 1.00 s", verdict(rows, "time")["figure"])

    def test_captures_that_disagree_are_undecided_and_failed_rows_do_not_count(self):
        rows = [r for c, best in (("can", 2), ("die", 3)) for o in (1, 2, 3, 4)
                for r in curve("fig:order", lift=0.5 if o == best else 0, capture=c, order=o)]
        self.assertIn("can agrees", self.expect("order", UNDECIDED, rows))
        for r in rows:
            r["status"] = "failed" if r["capture"] == "die" else "ok"
        self.expect("order", UNDECIDED, rows)

    def test_nothing_run_is_undecided(self):
        self.assertEqual({v["verdict"] for v in verdicts.judge([]).values()}, {UNDECIDED, "printed"})


class Flips(unittest.TestCase):
    def setUp(self):
        self.judged = {"order": {"finding": "o = 2", "verdict": AGREES, "figure": "+0.5 dB"},
                       "time": {"finding": "faster", "verdict": "printed", "figure": ""}}

    def test_the_recorded_verdict_passes(self):
        self.assertEqual(verdicts.flips(self.judged, {"order": {"verdict": AGREES, "figure": "+0.4 dB"}}), [])

    def test_a_flip_is_told_with_both_figures_and_how_to_record(self):
        lines = verdicts.flips(self.judged, {"order": {"verdict": CONTRADICTS, "figure": "-0.4 dB"}})
        self.assertIn('"o = 2" was: contradicts (-0.4 dB), is: agrees (+0.5 dB)', lines[0])
        self.assertIn("--record", lines[-1])

    def test_a_verdict_without_record_is_a_flip(self):
        self.assertIn("nothing recorded", verdicts.flips(self.judged, {})[0])


if __name__ == "__main__":
    unittest.main()
