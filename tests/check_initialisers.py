#!/usr/bin/env python3
"""No member of a header's types begins with whatever was in memory: each number, vector and matrix
has its initialiser, unless a constructor sets it (a private member, name_), its size comes later
(Dynamic), or the header is also C's. A test that passes by chance is found by no sanitizer.
Reads the headers; says file, line and member."""
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
NUMBER = r"float|double|int|bool|char|(?:std::)?size_t|(?:std::)?u?int(?:8|16|32|64)_t"
# AlignedBox is empty at first: Eigen sets it.
FIXED = (r"(?:Eigen::)?(?:Vector|Matrix|RowVector|Array|Quaternion|Isometry|Affine)\d?\d?[fdi]|"
         r"(?:Eigen::)?Matrix<[^;]*>")
MEMBER = re.compile(rf"^ +(?:mutable )?(?P<type>{NUMBER}|{FIXED}|(?:\w+::)*Joint) (?P<names>\w+(?:, \w+)*);",
                    re.M)

IN_C = re.compile(r'extern "C"|^typedef (?:struct|enum)\b', re.M)


def bare_members(text):
    """(line, name) of every member without an initialiser."""
    for found in MEMBER.finditer(text):
        if "Dynamic" in found["type"]:
            continue
        for name in found["names"].split(", "):
            if not name.endswith("_"):
                yield text.count("\n", 0, found.start()) + 1, name


def main():
    listed = subprocess.run(["git", "-C", TOP, "ls-files", "*.h"], capture_output=True, text=True,
                            check=True).stdout.split()
    bad = headers = 0
    for path in listed:
        text = (TOP / path).read_text(encoding="utf-8")
        if IN_C.search(text):
            continue
        headers += 1
        for line, name in bare_members(text):
            print(f"{path}:{line}: {name} has no initialiser: = 0, = false or its type's ::Zero()")
            bad += 1
    if headers < 100:
        print(f"expected the project's headers, found {headers}")
    return 1 if bad or headers < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
