"""What the tests of the Python package share. Run with PYTHONPATH=BUILD/python; OSSA_COMMAND is the
command of the same build."""

import os
import pathlib
import subprocess

import pytest

import ossa

TOP = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def clip():
    """24 images of one person, 320x240, with truth.jsonl."""
    return TOP / "tests/golden/clips/one"


@pytest.fixture(scope="session")
def shared():
    folder = TOP.parent / "shared"
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there")
    return folder


@pytest.fixture(scope="session")
def command():
    """Runs `ossa ARGUMENT...` and returns what it prints."""
    program = os.environ.get("OSSA_COMMAND", str(TOP / "build/bin/ossa"))

    def run(*arguments):
        done = subprocess.run(
            [program, *map(str, arguments)], check=True, capture_output=True, text=True
        )
        return done.stdout

    return run


@pytest.fixture(scope="session")
def models():
    """Read once for all tests."""
    return ossa.Models()


@pytest.fixture(scope="session")
def images(clip):
    return list(ossa.open(clip))


@pytest.fixture(scope="session")
def frames(clip, models):
    """The clip tracked, with all that a frame can hold."""
    tracker = ossa.Tracker(models=models, parts=True, probabilities=True, proposals=True)
    return list(tracker.run(clip))
