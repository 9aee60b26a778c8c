"""Skeletons from a RealSense by pyrealsense2 (pip install pyrealsense2).

Usage: realsense.py [FILE]    a camera, or what one recorded (.db3; by older versions .bag)
       realsense.py --pipe | ossa view -
"""

import sys

import numpy as np
import pyrealsense2 as rs

import ossa


def images(pipeline):
    """(depth_mm, camera, time_s) of each depth frame, until no more come."""
    profile = pipeline.get_active_profile()
    to_mm = 1000 * profile.get_device().first_depth_sensor().get_depth_scale()
    while True:
        ready, frames = pipeline.try_wait_for_frames(2000)
        if not ready:
            return
        depth = frames.get_depth_frame()
        lens = depth.profile.as_video_stream_profile().intrinsics
        depth_mm = np.rint(np.asanyarray(depth.get_data()) * to_mm).astype(np.uint16)
        yield depth_mm, ossa.Camera(lens.fx, lens.fy, lens.ppx, lens.ppy), depth.timestamp / 1000


if __name__ == "__main__":
    config, pipeline = rs.config(), rs.pipeline()
    config.enable_stream(rs.stream.depth)
    for file in [word for word in sys.argv[1:] if word != "--pipe"]:
        config.enable_device_from_file(file, repeat_playback=False)
    device = pipeline.start(config).get_device()
    if device.is_playback():
        device.as_playback().set_real_time(False)  # no frame is left out
    if "--pipe" in sys.argv:
        ossa.write_images(images(pipeline))
        sys.exit()
    tracker = ossa.Tracker()
    for image in images(pipeline):
        for body in tracker.track(*image).bodies:
            print(body.id, body["Head"])
