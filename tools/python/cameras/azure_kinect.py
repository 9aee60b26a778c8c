"""Skeletons from an Azure Kinect by pyk4a (pip install pyk4a), or from a recording without it.

Usage: azure_kinect.py [FILE.mkv]    a camera, or what k4arecorder recorded
       azure_kinect.py --pipe | ossa view -
"""

import sys

import ossa


def images():
    """(depth_mm, camera, time_s) of each capture of the first camera."""
    from pyk4a import CalibrationType, Config, DepthMode, PyK4A

    k4a = PyK4A(Config(depth_mode=DepthMode.NFOV_UNBINNED))
    k4a.start()
    lens = k4a.calibration.get_camera_matrix(CalibrationType.DEPTH)
    camera = ossa.Camera(lens[0, 0], lens[1, 1], lens[0, 2], lens[1, 2])
    while True:
        capture = k4a.get_capture()
        if capture.depth is not None:
            yield capture.depth, camera, capture.depth_timestamp_usec * 1e-6


if __name__ == "__main__":
    if "--pipe" in sys.argv:
        ossa.write_images(images())
        sys.exit()
    tracker = ossa.Tracker()
    for image in ossa.open(sys.argv[1]) if len(sys.argv) > 1 else images():
        for body in tracker.track(*image).bodies:
            print(body.id, body["Head"])
