"""Python packages from PyPI that tests use as clients which are not ours, in a folder of the build tree."""
import fcntl
import os
import pathlib
import subprocess
import sys

SKIPPED = 77  # the exit status by which CTest knows a test that was not run
LIST = pathlib.Path(__file__).with_name("python_packages.txt")


def fetch(folder):
    """Packages of python_packages.txt in `folder`, fetched once; they can be imported thereafter. Ends the program
    with a visible skip where they cannot be had."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    done = folder / "fetched"
    with open(folder / "lock", "w") as lock:  # tests run side by side
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not done.exists() or done.read_text() != LIST.read_text():
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
                   "--upgrade", "--require-hashes", "--target", str(folder / "site"), "--requirement", str(LIST)]
            result = subprocess.run(pip, capture_output=True, text=True, check=False)
            if result.returncode != 0:
                print(f"SKIPPED: PyPI's packages cannot be had: {result.stderr.strip().splitlines()[-1:]}")
                sys.stdout.flush()
                os._exit(SKIPPED)
            done.write_text(LIST.read_text())
    sys.path.insert(0, str(folder / "site"))
