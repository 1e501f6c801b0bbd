#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The line at the end of tools/test.sh says what passed, what failed, and what was skipped and why.

    test_summary_test.py TOOLS
"""
import pathlib
import sys
import tempfile

sys.path.insert(0, sys.argv[1])
import test_summary  # noqa: E402

RESULTS = """<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="(empty)" tests="7">
 <testcase name="A.One/1  # GetParam() = 8" status="run"><system-out>[  PASSED  ] 1 test.</system-out></testcase>
 <testcase name="B.Two" status="fail"><failure message=""/><system-out>wrong</system-out></testcase>
 <testcase name="C.Three" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/><system-out>
../tests/c.cpp:8: Skipped
no shared captures
[  SKIPPED ] C.Three (0 ms)</system-out></testcase>
 <testcase name="readers" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/><system-out>
there is no node
</system-out></testcase>
 <testcase name="gone" status="notrun"><skipped message="Unable to find executable"/><system-out></system-out></testcase>
 <testcase name="whole_program" status="run"><system-out>
../tests/d.cpp:9: Skipped
no shared captures
[  PASSED  ] 3 tests.</system-out></testcase>
 <testcase name="laboratory" status="run"><system-out>OK (skipped=2)</system-out></testcase>
</testsuite>
"""
EXPECTED = ("3 of 5 tests passed; failed: B.Two, gone; 5 skipped (2 tests, no shared captures: C.Three, part of whole_program; "
            "2 tests, said by its program: part of laboratory; 1 test, there is no node: readers)")


def main():
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "tests.xml"
        path.write_text(RESULTS, encoding="utf-8")
        said = test_summary.line(*test_summary.read(path))
    if said != EXPECTED:
        sys.exit(f"said:     {said}\nexpected: {EXPECTED}")


if __name__ == "__main__":
    main()
