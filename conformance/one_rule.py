#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Streams of refused/ that break one rule and no second one: without its check the text decoder decodes them.

    one_rule.py

CASES names the check (mutants/checks.txt) that is left out for each stream. With all checks the stream is refused; without that one it is not: a decoder that
lacks the check is told by these streams, whatever else it looks at. The older stream of the same rule, whose name is this one without "alone-", stays.
Needs numpy. Exit code: 0 all of them, 1 not.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "mutants"), str(HERE), str(HERE.parent / "spec")]
import run as mutants  # noqa: E402

CASES = {
    "alone-length-not-shortest": ["without-unit_length-in-read_units-3"],
    "alone-range-ends": ["without-sps_x_range_end-in-level_ranges"],
    "alone-cut-groups": ["without-sps_cut_groups-in-init"],
    "alone-cells-more": ["without-slice_num_points_minus1-in-init"],
    "alone-cells-of-all": ["without-slice_num_cells_minus1-in-init-2"],
    "alone-index-layer": ["without-refinement_layer-in-unit_kind"],
}


def refused(decoder, data):
    """Why the stream is refused, by a decoder as a module; nothing if it is not."""
    try:
        for units, light_field in decoder.light_fields(data):
            decoder.given_out(light_field.sequence, light_field, decoder.Wanted(light_field.sequence, 0, 0, 0), [])
    except decoder.Refused as problem:
        return str(problem)
    return ""


def main():
    checks, whole, wrong = {check.name: check for check in mutants.checks()}, mutants.loaded(mutants.SOURCE), 0
    for name, (check,) in CASES.items():
        data = (HERE / "refused" / name / "stream.slf").read_bytes()
        with_all, without = refused(whole, data), refused(mutants.loaded(checks[check].source()), data)
        if not with_all or without:
            wrong += 1
            print(f"{name}: {with_all or 'is decoded'}; without the check: {without or 'is decoded'}")
    print(f"{len(CASES) - wrong} of {len(CASES)} streams break one rule alone")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
