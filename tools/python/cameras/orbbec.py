"""Skeletons from an Orbbec Femto, Gemini or Astra by pyorbbecsdk (pip install pyorbbecsdk).

Usage: orbbec.py, or orbbec.py --pipe | ossa view -
"""

import sys

import numpy as np
import pyorbbecsdk as ob

import ossa


def image_of(depth):
    """(depth_mm, camera, time_s) of a depth frame."""
    values = np.frombuffer(depth.get_data(), np.uint16) * depth.get_depth_scale()
    depth_mm = np.rint(values).astype(np.uint16).reshape(depth.get_height(), depth.get_width())
    profile = depth.get_stream_profile().as_video_stream_profile()
    lens = profile.get_intrinsic()
    camera = ossa.Camera(lens.fx, lens.fy, lens.cx, lens.cy)
    return depth_mm, camera, depth.get_timestamp_us() * 1e-6


def images(pipeline):
    """image_of each depth frame, as long as they come."""
    while True:
        frames = pipeline.wait_for_frames(1000)
        depth = frames.get_depth_frame() if frames else None
        if depth:
            yield image_of(depth)


if __name__ == "__main__":
    pipeline, config = ob.Pipeline(), ob.Config()
    profiles = pipeline.get_stream_profile_list(ob.OBSensorType.DEPTH_SENSOR)
    config.enable_stream(profiles.get_default_video_stream_profile())
    pipeline.start(config)
    if "--pipe" in sys.argv:
        ossa.write_images(images(pipeline))
        sys.exit()
    tracker = ossa.Tracker()
    for image in images(pipeline):
        for body in tracker.track(*image).bodies:
            print(body.id, body["Head"])
