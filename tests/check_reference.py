#!/usr/bin/env python3
"""Makes the API reference (docs/Doxyfile) and lists public names without documentation.

Usage: check_reference.py   ($OSSA_REFERENCE_DIR: where to write it; default: a folder that goes away)

Public headers are the HEADERS of ossa_library in the CMakeLists.txt of the rooms. Types, enumerations and
functions need a comment; a member whose name says what it is does not. Every other warning of Doxygen
(a parameter that does not exist, a broken reference) fails, too.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent
LIBRARY = re.compile(r"ossa_library\((.*?)\n\)", re.S)
HEADERS = re.compile(r"\bHEADERS\b(.*?)(?=\n\s*(?:SOURCES|PUBLIC|PRIVATE)\b|\Z)", re.S)
# Members of a documented type need none: their names describe them.
NEEDS_NONE = re.compile(r"Member .* of (?:class|struct|union) .* is not documented|\(macro definition\)")


def public_headers():
    found = []
    for cmake in sorted(TOP.glob("*/CMakeLists.txt")) + sorted(TOP.glob("tools/*/CMakeLists.txt")):
        for library in LIBRARY.findall(re.sub(r"#.*", "", cmake.read_text())):
            for headers in HEADERS.findall(library):
                found += [cmake.parent / name for name in headers.split() if name.endswith(".h")]
    return sorted({path.relative_to(TOP).as_posix() for path in found if path.is_file()})


def warnings_of(headers, folder):
    config = f"@INCLUDE = docs/Doxyfile\nINPUT = {' '.join(headers)}\nOUTPUT_DIRECTORY = {folder}\n"
    done = subprocess.run(["doxygen", "-"], cwd=TOP, input=config, capture_output=True, text=True)
    if done.returncode != 0:
        return [f"doxygen: exit status {done.returncode}", *done.stderr.splitlines()]
    return [line.replace(f"{TOP}/", "") for line in done.stderr.splitlines() if "warning:" in line]


def main():
    headers = public_headers()
    if len(headers) < 10:
        print(f"expected public headers in the CMakeLists.txt of the rooms, found {len(headers)}")
        return 1
    with tempfile.TemporaryDirectory() as spare:
        found = warnings_of(headers, os.environ.get("OSSA_REFERENCE_DIR", spare))
    found = [line for line in found if not NEEDS_NONE.search(line)]
    print("\n".join(found)) if found else None
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
