#!/usr/bin/env python3
"""Every test named in docs/benchmarks/robustness.md exists: `Suite.Name`, or `Suite.*`.

Usage: check_named_tests.py [TOP]. Prints missing ones; exit status 1 if any.
"""
import fnmatch
import re
import sys
from pathlib import Path

TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", re.MULTILINE)
SUITE = re.compile(r"INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+),")
NAMED = re.compile(r"`(?:\w+/)?([A-Z]\w+\.[A-Z*]\w*)`")


def main():
    top = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1]
    tests = set()
    for source in (top / "tests").rglob("*.cpp"):
        text = source.read_text()
        tests.update(f"{suite}.{name}" for suite, name in TEST.findall(text))
        tests.update(f"{prefix}.{suite}" for prefix, suite in SUITE.findall(text))
    page = top / "docs/benchmarks/robustness.md"
    missing = [name for name in NAMED.findall(page.read_text()) if not fnmatch.filter(tests, name)]
    for name in missing:
        print(f"{page.relative_to(top)}: no such test: {name}")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
