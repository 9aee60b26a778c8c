"""Skeletons from a Kinect v1 by libfreenect's Python binding (pip install freenect).

Usage: kinect_v1.py, or kinect_v1.py --pipe | ossa view -
`ossa.open("openni:")` reads a Kinect v1 too, by ossa's own driver.
"""

import sys
import time

import freenect
import numpy as np

import ossa

CAMERA = ossa.Camera.preset("kinect-v1")


def images():
    """(depth_mm, camera, time_s) of each image of the first Kinect, until it stops."""
    while True:
        got = freenect.sync_get_depth(format=freenect.DEPTH_MM)
        if got is None:
            return
        depth_mm, _ = got
        yield np.ascontiguousarray(depth_mm, dtype=np.uint16), CAMERA, time.monotonic()


if __name__ == "__main__":
    if "--pipe" in sys.argv:
        ossa.write_images(images())
        sys.exit()
    tracker = ossa.Tracker()
    for image in images():
        for body in tracker.track(*image).bodies:
            print(body.id, body["Head"])
