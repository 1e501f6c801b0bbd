# SPDX-License-Identifier: Apache-2.0
"""bd.py against cases with a known answer. Where the vectors come from stands at each."""
import math
import unittest

from bd import NoFigure, bd_psnr, bd_rate

# JCTVC-E137 (Geneva 2011), as published with its results in Netflix/vmaf,
# python/test/bd_rate_calculator_test.py (PCHIP, fractions there, percent here).
E137 = [
    (([108048.8736, 61279.976, 33905.6656, 18883.6928], [43.6471, 40.3953, 37.247, 34.2911]),
     ([108061.2784, 61299.9936, 33928.7472, 18910.912], [43.6768, 40.4232, 37.2761, 34.3147]), -0.465215420752807),
    (([40433.8848, 7622.7456, 2394.488, 1017.6184], [37.5761, 35.3756, 33.8977, 32.0603]),
     ([40370.12, 7587.0024, 2390.0944, 1017.0984], [37.5982, 35.4025, 33.9194, 32.0822]), -1.8779823450567612),
]
# The classic example of VCEG-M33 implementations (e.g. Anserw/Bjontegaard_metric, demo.py), which give
# one cubic polynomial through the four points; recomputed with numpy.polyfit: 31.3974 %, -1.1849 dB.
CLASSIC = (([686.76, 309.58, 157.11, 85.95], [40.28, 37.18, 34.24, 31.42]),
           ([893.34, 407.8, 204.93, 112.75], [40.39, 37.21, 34.17, 31.24]))
LINE = ([1e4, 2e4, 4e4, 8e4], [30.0, 32.0, 34.0, 36.0])


def scaled(curve, rate=1.0, psnr=0.0):
    return [rate * r for r in curve[0]], [p + psnr for p in curve[1]]


class Analytic(unittest.TestCase):
    def test_four_fifths_of_the_rate_is_minus_20_percent(self):
        for method in ("pchip", "akima"):
            for curve in (LINE, CLASSIC[0], E137[1][0]):
                self.assertAlmostEqual(bd_rate(*curve, *scaled(curve, rate=0.8), method), -20, places=9)

    def test_a_straight_curve_shifted_up_by_half_a_db(self):
        # PSNR rises by 2 dB per doubling, so half a dB is worth 2^(-1/4) in rate.
        for method in ("pchip", "akima"):
            higher = scaled(LINE, psnr=0.5)
            self.assertAlmostEqual(bd_psnr(*LINE, *higher, method), 0.5, places=9)
            self.assertAlmostEqual(bd_rate(*LINE, *higher, method), 100 * (2 ** -0.25 - 1), places=9)

    def test_the_order_of_the_points_does_not_matter(self):
        turned = tuple(values[::-1] for values in CLASSIC[1])
        self.assertEqual(bd_rate(*CLASSIC[0], *CLASSIC[1]), bd_rate(*CLASSIC[0], *turned))

    def test_exchanging_the_curves_inverts_the_ratio(self):
        there, back = bd_rate(*CLASSIC[0], *CLASSIC[1]), bd_rate(*CLASSIC[1], *CLASSIC[0])
        self.assertAlmostEqual((1 + there / 100) * (1 + back / 100), 1, places=12)


class Published(unittest.TestCase):
    def test_jctvc_e137_to_the_last_digit(self):
        for anchor, test, expected in E137:
            self.assertAlmostEqual(bd_rate(*anchor, *test), expected, places=9)

    def test_jctvc_e137_by_akima(self):
        # Android's media test BdRateCalculatorTests adds a PCHIP point (Akima there wants five) and
        # holds Akima to 0.00005 of the published fraction: 0.005 here, in percent.
        anchor, test, expected = E137[0]
        anchor = (anchor[0] + [78915.635], anchor[1] + [41.8147])
        test = (test[0] + [78532.332], test[1] + [41.8147])
        self.assertAlmostEqual(bd_rate(*anchor, *test, "akima"), expected, delta=0.005)

    def test_jctvc_e137_bd_psnr(self):
        # 0.028504 +- 0.00005 dB: Android's BdQualityCalculatorTests, second case.
        anchor, test, _ = E137[1]
        self.assertAlmostEqual(bd_psnr(*anchor, *test), 0.028504, delta=0.00005)

    def test_cubic_results_differ_by_the_method_only(self):
        # On curves as smooth as this one the three methods agree to 0.02 % and 0.002 dB.
        for method in ("pchip", "akima"):
            self.assertAlmostEqual(bd_rate(*CLASSIC[0], *CLASSIC[1], method), 31.3974, delta=0.02)
            self.assertAlmostEqual(bd_psnr(*CLASSIC[0], *CLASSIC[1], method), -1.1849, delta=0.002)


class Refused(unittest.TestCase):
    def refuse(self, reason, anchor, test, measure=bd_rate):
        with self.assertRaisesRegex(NoFigure, reason):
            measure(*anchor, *test)

    def test_fewer_than_four_points(self):
        self.refuse("the test has 3 points", LINE, (LINE[0][:3], LINE[1][:3]))

    def test_not_monotone(self):
        self.refuse("the test is not monotone: 32.000 dB", LINE, (LINE[0], [30, 32, 31, 36]))
        self.refuse("occurs twice", LINE, ([1, 1, 2, 3], LINE[1]))

    def test_nan_and_infinity(self):
        self.refuse("not a finite number", LINE, (LINE[0], [30, math.nan, 34, 36]))
        self.refuse("not a finite number", ([1, 2, 3, math.inf], LINE[1]), LINE)

    def test_rate_of_zero(self):
        self.refuse("not positive", ([0, 1, 2, 3], LINE[1]), LINE)

    def test_lengths_differ(self):
        self.refuse("4 rates but 5 PSNRs", (LINE[0], LINE[1] + [40]), LINE)

    def test_less_than_a_quarter_of_the_smaller_range_in_common(self):
        bd_rate(*LINE, *scaled(LINE, psnr=4.4))  # 1.6 of 6 dB
        self.refuse(r"overlap by 23 % of the smaller", LINE, scaled(LINE, psnr=4.6))
        self.refuse(r"overlap by 0 %", LINE, scaled(LINE, psnr=50))
        self.refuse(r"overlap by 0 %", LINE, scaled(LINE, rate=100), bd_psnr)


if __name__ == "__main__":
    unittest.main()
