#!/usr/bin/env python3
"""Python packages from PyPI that tests use as independent clients: small ones in a folder of the build tree,
Blender in the user's cache. As a program: fetches Blender.

usage: tests/support/pypi.py blender
"""
import fcntl
import os
import pathlib
import subprocess
import sys

SKIPPED = 77  # the exit status by which CTest knows a test that was not run
LIST = pathlib.Path(__file__).with_name("python_packages.txt")
BLENDER = pathlib.Path(__file__).with_name("blender_package.txt")


def install(packages, folder):
    """Fetches the packages of a list into folder/site, once; returns the reason if that fails."""
    folder.mkdir(parents=True, exist_ok=True)
    done = folder / "fetched"
    with open(folder / "lock", "w") as lock:  # tests run side by side
        fcntl.flock(lock, fcntl.LOCK_EX)
        if done.exists() and done.read_text() == packages.read_text():
            return None
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
               "--no-cache-dir", "--upgrade", "--require-hashes", "--target", str(folder / "site"),
               "--requirement", str(packages)]
        result = subprocess.run(pip, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            return f"PyPI's packages cannot be had: {result.stderr.strip().splitlines()[-1:]}"
        done.write_text(packages.read_text())
    return None


def fetch(folder):
    """Packages of python_packages.txt in `folder`, fetched once; they can be imported thereafter. Ends the program
    with a visible skip where they cannot be had."""
    reason = install(LIST, pathlib.Path(folder))
    if reason is not None:
        print(f"SKIPPED: {reason}")
        sys.stdout.flush()
        os._exit(SKIPPED)
    sys.path.insert(0, str(pathlib.Path(folder) / "site"))


def blender_folder():
    """The folder of Blender, 1.4 GB, outside of any build tree."""
    home = os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
    return pathlib.Path(home) / "ossa" / "blender"


def find_blender():
    """Lets `import bpy` find what `pypi.py blender` fetched. Why not, where it did not: no test fetches 519 MB by
    itself."""
    done = blender_folder() / "fetched"
    if sys.version_info[:2] != (3, 11) or not done.exists() or done.read_text() != BLENDER.read_text():
        return "no Blender for this Python: python3.11 tests/support/pypi.py blender fetches it"
    sys.path.append(str(blender_folder() / "site"))
    return None


if __name__ == "__main__":
    if sys.argv[1:] != ["blender"]:
        sys.exit(__doc__)
    REASON = install(BLENDER, blender_folder())
    if REASON is not None:
        print(f"pypi.py: no Blender: {REASON}")  # its tests are skipped and say so
