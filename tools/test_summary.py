#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One line about a run of ctest: what passed, how many, and what was skipped and why.

    test_summary.py JUNIT        JUNIT: what ctest --output-junit has written
"""
import re
import sys
import xml.etree.ElementTree as ElementTree

NAMED = 3                                   # tests of a kind that are named


def short(name):
    """A test's name without its parameter and the words of its suite's instance."""
    return name.split("  # ")[0]


def reasons(output):
    """Why a program skipped tests: GTEST_SKIP() << why, each once for a test; unittest and pytest give numbers alone."""
    given = [why.strip() or "no reason" for why in re.findall(r": Skipped\n(.*)", output)]
    numbers = re.findall(r"\bskipped=(\d+)|\b(\d+) skipped\b", output)
    return given or ["said by its program"] * sum(int(a or b) for a, b in numbers)


def last_line(output):
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    return lines[-1] if lines else "no reason"


def has_failed(test):
    """Also what could not be started, or stands on what failed; but not what skipped itself."""
    message = getattr(test.find("skipped"), "attrib", {}).get("message", "")
    return test.get("status") == "fail" or test.get("status") == "notrun" and not message.startswith("SKIP_")


def skipped_in(test, output):
    """Reasons of what a test skipped. One reason that stands for all of it, or those of parts of it."""
    if test.get("status") == "disabled":
        return ["disabled"]
    if test.get("status") == "run":
        return reasons(output)
    return reasons(output)[:1] or [last_line(output)]


def read(path):
    """Names of tests: passed, failed; and by reason what was skipped."""
    passed, failed, skipped = [], [], {}
    for test in ElementTree.parse(path).getroot().iter("testcase"):
        name, output = short(test.get("name")), test.findtext("system-out") or ""
        if has_failed(test):
            failed.append(name)
            continue
        whole = test.get("status") == "run"
        if whole:
            passed.append(name)
        for why in skipped_in(test, output):
            skipped.setdefault(why, []).append(f"part of {name}" if whole else name)
    return passed, failed, skipped


def some(names):
    """Some names of a list, and how many more there are."""
    once = list(dict.fromkeys(names))
    more = len(once) - NAMED
    return ", ".join(once[:NAMED]) + (f" and {more} more" if more > 0 else "")


def line(passed, failed, skipped):
    """The line."""
    said = f"{len(passed)} of {len(passed) + len(failed)} tests passed"
    if failed:
        said += f"; failed: {some(failed)}"
    count = sum(map(len, skipped.values()))
    why = [f"{len(names)} {'test' if len(names) == 1 else 'tests'}, {reason}: {some(names)}"
           for reason, names in sorted(skipped.items(), key=lambda item: -len(item[1]))]
    return said + (f"; {count} skipped ({'; '.join(why)})" if count else "; none skipped")


def main():
    try:
        print("test.sh:", line(*read(sys.argv[1])))
    except (OSError, ElementTree.ParseError) as problem:
        print(f"test.sh: ctest left no results ({problem})")


if __name__ == "__main__":
    main()
