"""Shared by the tests of the NiTE interface: paths, the clip, and the started PyPI package `openni`."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

BUILD = pathlib.Path(os.environ["OSSA_BUILD"])
WORK = pathlib.Path(os.environ["OSSA_WORK"])  # of this test alone
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
import pypi  # noqa: E402

pypi.fetch(BUILD / "python_packages")
from openni import openni2, nite2  # noqa: E402
from openni.utils import NiteError  # noqa: E402,F401

import gesture_clip  # noqa: E402

# NiTE's joint -> the joint of truth files that lies at the same place.
PLACES = {0: "Head", 1: "ShoulderCenter", 2: "ShoulderLeft", 3: "ShoulderRight", 4: "ElbowLeft", 5: "ElbowRight",
          6: "HandLeft", 7: "HandRight", 9: "HipLeft", 10: "HipRight", 11: "KneeLeft", 12: "KneeRight",
          13: "AnkleLeft", 14: "AnkleRight"}
LEFT_HAND, RIGHT_HAND = 6, 7


def main():
    """Runs the tests of the program in a fresh folder."""
    shutil.rmtree(WORK, ignore_errors=True)
    unittest.main()


def start():
    openni2.initialize(str(BUILD / "lib" / "openni2"))
    nite2.initialize(str(BUILD / "lib" / "ossa" / "nite2"))


def stop():
    nite2.unload()
    openni2.unload()


def make_clip(name="gestures", size="320x240", seed=1):
    """The gestures as a virtual camera plays them: a data set's folder."""
    motion, clip = WORK / "motion", WORK / name
    motion.mkdir(parents=True, exist_ok=True)
    gesture_clip.write_bvh(motion / "gestures.bvh")
    subprocess.run([BUILD / "bin" / "ossa", "render", "--mocap", motion, "--out", clip, "--sequence", "--view", "front",
                    "--size", size, "--bodies", "average", "--background", "none", "--seed", str(seed), "--quiet",
                    "--frames", str(gesture_clip.frame_count())], check=True)
    return clip


def camera(clip, options=""):
    return openni2.Device(f"ossa://{clip}{options}".encode())


def truth_of(clip):
    """Frame -> joint -> place, camera space (metres, x to the sensor's left)."""
    frames = {}
    for line in (clip / "truth.jsonl").read_text().splitlines():
        frame = json.loads(line)
        frames[frame["frame"]] = {name: joint["p"] for name, joint in frame["bodies"][0]["joints"].items()}
    return frames


def place(point, mirrored=False):
    """NiTE's millimetres as metres of camera space."""
    return ((1 if mirrored else -1) * point.x / 1000, point.y / 1000, point.z / 1000)


def distance(a, b):
    return math.dist(a, b)
