#!/usr/bin/env python3
"""Conventions of the scripts: help, wrong arguments without side effects, and existing folders for tools/demo.

Usage: scripts_test.py
"""
import hashlib
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tools"))
sys.dont_write_bytecode = True
from wheel_data import MARK, WheelData  # noqa: E402  (of tools)

# What each is for stands at its top; those that only tests call say how they are called.
WITH_HELP = ("tools/demo", "tools/install_packages", "tools/fetch_body", "tools/fetch_mocap", "tools/python/make_wheel",
             "tests/run")
OF_TESTS = ("tests/packages/try_packages", "tests/packages/in_clean_root", "tests/python/make_environment",
            "tests/python/run_pytest", "tests/python/wheel_in_clean_root", "tests/arm64/make_root",
            "tests/arm64/check_rounding", "tests/fuzz/run_one", "tests/sanitize_threads", "tests/nite2/public_programs",
            "tests/run_tutorials.py")


def run(script, *arguments, **options):
    return subprocess.run([TOP / script, *arguments], capture_output=True, text=True, timeout=30, **options)


class Arguments(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)

    def check_that_nothing_is_made(self):
        self.assertEqual(os.listdir(self.temporary.name), [])

    def test_help_describes_the_script(self):
        for script in WITH_HELP:
            done = run(script, "--help", cwd=self.temporary.name)
            self.assertEqual((done.returncode, done.stderr), (0, ""), script)
            self.assertIn(pathlib.Path(script).name, done.stdout, script)
            self.assertGreater(len(done.stdout.splitlines()), 2, script)
        self.check_that_nothing_is_made()

    def test_folder_with_other_files_is_refused_as_root(self):
        mine = pathlib.Path(self.temporary.name) / "mine.txt"
        mine.touch()
        self.assertEqual(run("tests/arm64/make_root", self.temporary.name).returncode, 2)
        self.assertTrue(mine.exists())

    def test_invalid_ones_are_refused(self):
        for script in (*WITH_HELP, *OF_TESTS):
            done = run(script, "--nonsense", cwd=self.temporary.name)
            self.assertEqual(done.returncode, 2, f"{script}: {done.stdout}{done.stderr}")
        for script, arguments in {"tests/run": ["--quick", "--full"], "tools/python/make_wheel": [],
                                  "tools/install_packages": ["--tests", "--nonsense"]}.items():
            self.assertEqual(run(script, *arguments, cwd=self.temporary.name).returncode, 2, script)
        self.check_that_nothing_is_made()


class FetchedFolder(unittest.TestCase):
    """The folder that tools/fetch_body and tools/fetch_mocap fetch into."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name) / "data"
        self.wheel = pathlib.Path(self.temporary.name) / "x.whl"
        with zipfile.ZipFile(self.wheel, "w") as archive:
            archive.writestr("x/body.obj", "v 0 0 0")
        sha256 = hashlib.sha256(self.wheel.read_bytes()).hexdigest()
        self.data = WheelData("fetch_x", "x==1", sha256, lambda member: pathlib.Path(member).name)

    def fetch(self):
        return self.data.bring(str(self.folder), str(self.wheel))

    def files(self):
        return sorted(os.listdir(self.folder))

    def test_appears_complete_and_once(self):
        self.assertEqual((self.fetch(), self.fetch()), (1, 0))
        self.assertEqual(self.files(), ["body.obj", MARK])
        self.assertEqual(sorted(os.listdir(self.folder.parent)), ["data", "x.whl"])

    def test_of_another_version_is_replaced(self):
        self.folder.mkdir()
        (self.folder / MARK).write_text("another hash\n")
        (self.folder / "old.obj").touch()
        self.assertEqual(self.fetch(), 1)
        self.assertEqual(self.files(), ["body.obj", MARK])

    def test_of_a_concurrent_fetch_is_kept(self):
        def place(member):
            self.data.place = lambda member: None
            self.folder.mkdir()
            (self.folder / "theirs.obj").touch()
            (self.folder / MARK).write_text(self.data.sha256 + "\n")
            return pathlib.Path(member).name
        self.data.place = place
        self.fetch()
        self.assertEqual(self.files(), [MARK, "theirs.obj"])

    def test_with_other_files_is_not_changed(self):
        self.folder.mkdir()
        (self.folder / "mine.txt").touch()
        with self.assertRaises(SystemExit) as refused:
            self.fetch()
        self.assertIn(f"{self.folder}: expected a folder that fetch_x made", str(refused.exception))
        self.assertEqual(self.files(), ["mine.txt"])


class Demo(unittest.TestCase):
    """tools/demo in a checkout whose name has a blank, with stand-ins of what it calls."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.top = pathlib.Path(self.temporary.name) / "my ossa"
        self.build, self.said = self.top / "build", self.top / "said"
        (self.top / "tools/tracker/shipped").mkdir(parents=True)
        (self.top / "tools/tracker/shipped/body.ossa").touch()
        shutil.copy(TOP / "tools/demo", self.top / "tools/demo")
        for program in ("tools/install_packages", "tools/fetch_body", "path/cmake", "build/bin/ossa"):
            self.put(program)

    def put(self, program):
        file = self.top / program
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text('#!/bin/sh\necho "${0##*/} $*" >>' + shlex.quote(str(self.said)) + "\n")
        file.chmod(0o755)

    def play(self):
        done = subprocess.run([self.top / "tools/demo"], capture_output=True, text=True, cwd="/", timeout=30,
                              env={**os.environ, "PATH": f"{self.top / 'path'}:{os.environ['PATH']}", "OSSA_BUILD_DIR": ""})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, self.said.read_text()

    def test_prints_a_command_that_can_be_pasted_at_its_end(self):
        out, _ = self.play()
        words = shlex.split(out.splitlines()[-1].split("browser: ")[1])
        self.assertEqual(words, [str(self.build / "bin/ossa"), "view", str(self.top / "out/demo/clip.oni"), "--physics", "on"])

    def test_replaces_data_sets_of_an_earlier_run_and_nothing_else(self):
        for name, file in (("images", "mine.txt"), ("clip", "manifest.json")):
            (self.top / "out/demo" / name).mkdir(parents=True)
            (self.top / "out/demo" / name / file).touch()
        self.play()
        self.assertTrue((self.top / "out/demo/images/mine.txt").exists())
        self.assertFalse((self.top / "out/demo/clip").exists())

    def test_configures_a_fresh_folder_for_ninja(self):
        self.assertIn("cmake -G Ninja", self.play()[1])

    def test_builds_a_folder_that_was_configured_for_make(self):
        (self.build / "CMakeCache.txt").touch()
        (self.build / "Makefile").touch()
        said = self.play()[1]
        self.assertNotIn(" -S ", said)
        self.assertIn("cmake --build", said)

    def test_keeps_the_generator_of_an_incomplete_configuration(self):
        (self.build / "CMakeCache.txt").touch()
        said = self.play()[1]
        self.assertIn(" -S ", said)
        self.assertNotIn("Ninja", said)


if __name__ == "__main__":
    unittest.main()
