"""Skeletons from any OpenNI2 device or .oni file by the binding `openni` (pip install openni).

Usage: openni2.py [FILE.oni]    `ossa.open("openni:")` and `ossa.open("FILE.oni")` do without it.
"""

import math
import os
import sys

import numpy as np
from openni import openni2

import ossa

LIBRARIES = os.environ.get("OPENNI2_REDIST", "/usr/lib/x86_64-linux-gnu")  # Debian's libOpenNI2


def images(device, count=None):
    """(depth_mm, camera, time_s) of a device's depth images; `count` of a recording."""
    stream = device.create_depth_stream()
    stream.start()
    while count is None or count > 0:
        count = None if count is None else count - 1
        frame = stream.read_frame()
        w, h = frame.width, frame.height
        f = w / 2 / math.tan(stream.get_horizontal_fov() / 2)
        depth_mm = np.array(frame.get_buffer_as_uint16()).reshape(h, w)  # copied from OpenNI2's
        if stream.get_mirroring_enabled():  # as OpenNI2 likes to; left would be right
            depth_mm = np.ascontiguousarray(depth_mm[:, ::-1])
        yield depth_mm, ossa.Camera(f, f, w / 2, h / 2), frame.timestamp * 1e-6


if __name__ == "__main__":
    openni2.initialize(LIBRARIES)
    device = openni2.Device(sys.argv[1].encode() if len(sys.argv) > 1 else None)
    tracker = ossa.Tracker()
    for image in images(device):
        for body in tracker.track(*image).bodies:
            print(body.id, body["Head"])
