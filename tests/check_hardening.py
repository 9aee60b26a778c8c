#!/usr/bin/env python3
"""What is built is hardened as docs/benchmarks/robustness.md says.

    check_hardening.py FILE...

Of each program or library the table of addresses is closed after loading (full RELRO) and stacks are guarded; somewhere
among them library calls are the checked ones (`__*_chk`) and the standard library's assertions are called.
"""
import re
import subprocess
import sys


def readelf(file, *what):
    return subprocess.run(["readelf", "--wide", *what, file], check=True, capture_output=True, text=True).stdout


def is_relro_full(file):
    return "GNU_RELRO" in readelf(file, "--program-headers") and re.search(r"BIND_NOW|\bNOW\b", readelf(file, "--dynamic"))


def undefined_symbols(file):
    return set(re.findall(r" UND ([^@\s]+)", readelf(file, "--dyn-syms")))


def main():
    files = sys.argv[1:]
    if not files:
        print(__doc__, file=sys.stderr)
        return 2
    faults = [f"{file}: expected full RELRO (-z relro -z now)" for file in files if not is_relro_full(file)]
    symbols = {file: undefined_symbols(file) for file in files}
    for file in files:
        if "__stack_chk_fail" not in symbols[file]:
            faults.append(f"{file}: expected guarded stacks (__stack_chk_fail)")
    everything = set().union(*symbols.values())
    if not any(name.endswith("_chk") for name in everything):
        faults.append("expected checked library calls (_FORTIFY_SOURCE): no symbol ends in _chk")
    if not any("__glibcxx_assert_fail" in name for name in everything):
        faults.append("expected the standard library's assertions (_GLIBCXX_ASSERTIONS): nothing calls them")
    print("\n".join(faults) or f"{len(files)} files are hardened")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
