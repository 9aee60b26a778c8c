#!/usr/bin/env python3
"""Runs the commands of each tutorial as a reader would type them, in a fresh folder.

Usage: run_tutorials.py OSSA [TUTORIAL...]   (OSSA: the command; all of docs/tutorials without TUTORIAL)

Fenced `sh` blocks run one after another. A comment before a block makes it small or leaves it out:
    <!-- run with: LONG -> SHORT; LONG -> SHORT -->    every LONG must be in the block
    <!-- not run: REASON -->
Nothing else is replaced. Prints the command that failed, and its output; exit status 1.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"(?:^<!-- (?P<how>[^\n]*?) -->\n)?^```sh\n(?P<commands>.*?)^```", re.M | re.S)
LIMIT_S = 120  # of a block; by hand: each takes seconds


def blocks_of(path):
    """The commands of each block that runs, made small; ValueError where a comment does not fit its block."""
    for match in BLOCK.finditer(path.read_text()):
        how, commands = match.group("how") or "", match.group("commands")
        if how.startswith("not run: "):
            continue
        if how and not how.startswith("run with: "):
            raise ValueError(f"{path}: <!-- {how} -->: expected 'run with: ' or 'not run: '")
        for change in how.removeprefix("run with: ").split("; ") if how else []:
            long, short = change.split(" -> ")
            if long not in commands:
                raise ValueError(f"{path}: no block has '{long}' where a comment replaces it")
            commands = commands.replace(long, short)
        yield commands


def run_tutorial(ossa, path):
    with tempfile.TemporaryDirectory() as folder:
        for commands in blocks_of(path):
            script = f'set -euo pipefail\nossa() {{ "{ossa}" "$@"; }}\n{commands}'
            try:
                done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, timeout=LIMIT_S)
            except subprocess.TimeoutExpired:
                print(f"{path}: took more than {LIMIT_S} s:\n{commands}")
                return False
            if done.returncode != 0:
                print(f"{path}: exit status {done.returncode} of:\n{commands}\n{done.stdout}{done.stderr}")
                return False
    return True


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 2
    ossa = pathlib.Path(sys.argv[1]).resolve()
    paths = [pathlib.Path(name) for name in sys.argv[2:]] or sorted((TOP / "docs" / "tutorials").glob("*.md"))
    if not any(True for path in paths for _ in blocks_of(path)):
        print("expected tutorials with commands in docs/tutorials")
        return 1
    return 0 if all([run_tutorial(ossa, path) for path in paths]) else 1


if __name__ == "__main__":
    sys.exit(main())
