#!/usr/bin/env python3
"""One name, one type: a type that is defined in two files under one name (no namespace { } around
it, not inside a function) breaks C++'s one-definition rule, which no compiler or linker tells; where
the two differ, whichever destructor or member function the linker keeps works on the other's bytes.
Reads the sources; says file, file and name."""
import collections
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
NOT_CODE = re.compile(r'R"(\w*)\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"'
                      r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\])+'", re.S)
NAMESPACE = re.compile(r"\bnamespace(?:\s+([\w:]+))?\s*$")
TYPE = re.compile(r"\b(?:struct|class|union|enum(?:\s+class)?)\s+([A-Z]\w*)(?:\s+final)?"
                  r"\s*(?::[^:].*)?$", re.S)
ANONYMOUS, BODY = object(), object()


def types_of(text):
    """Full names of the types that other files would see as the same."""
    scopes, last = [], 0
    text = NOT_CODE.sub(" ", text)
    for mark in re.finditer(r"[{};]", text):
        head = text[last:mark.start()]
        last = mark.end()
        if mark.group() == "}" and scopes:
            scopes.pop()
        if mark.group() != "{":
            continue
        namespace, kind = NAMESPACE.search(head), TYPE.search(head)
        if namespace:
            scopes.append(namespace.group(1) or ANONYMOUS)
        elif kind and not head.rstrip().endswith(")"):
            if ANONYMOUS not in scopes and BODY not in scopes:
                yield "::".join(scopes + [kind.group(1)])
            scopes.append(kind.group(1))
        else:
            scopes.append(BODY)


def main():
    listed = subprocess.run(["git", "-C", TOP, "ls-files", "*.h", "*.cpp"], capture_output=True, text=True,
                            check=True).stdout.split()
    homes = collections.defaultdict(set)
    for path in listed:
        with open(TOP / path, encoding="utf-8") as source:
            for name in types_of(source.read()):
                homes[name].add(path)
    twice = {name: paths for name, paths in homes.items() if len(paths) > 1}
    for name, paths in sorted(twice.items()):
        print(f"{name} is defined in {' and in '.join(sorted(paths))}: put the ones of .cpp files "
              "into a namespace without a name")
    if len(homes) < 100:
        print(f"expected the project's types, found {len(homes)}")
    return 1 if twice or len(homes) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
