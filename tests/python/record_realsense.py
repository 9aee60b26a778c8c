"""Records depth images as a RealSense that is software.

Usage: record_realsense.py IMAGES.npz RECORDING    depth_mm (n, height, width), times_s (n,), camera (4,)
"""

import sys
import time
import types

import numpy as np


def lens_of(rs, image):
    lens = rs.intrinsics()
    lens.height, lens.width = image.depth_mm.shape
    camera = image.camera
    lens.fx, lens.fy, lens.ppx, lens.ppy = camera.fx, camera.fy, camera.cx, camera.cy
    lens.model = rs.distortion.brown_conrady
    return lens


def record_realsense(rs, images, path, *compressed):
    """Plays the images on the device, and lets pyrealsense2 (rs) record it; its frames."""
    lens = lens_of(rs, images[0])
    device = rs.software_device()
    sensor = device.add_sensor("Depth")
    sensor.add_read_only_option(rs.option.depth_units, 0.001)
    stream = rs.video_stream()
    stream.type, stream.fmt, stream.bpp, stream.fps = rs.stream.depth, rs.format.z16, 2, 30
    stream.width, stream.height, stream.intrinsics = lens.width, lens.height, lens
    profile = sensor.add_video_stream(stream)
    recorder = rs.recorder(str(path), device, *compressed)
    recorded = recorder.query_sensors()[0]
    queue = rs.frame_queue(len(images))
    recorded.open(recorded.get_stream_profiles()[0])
    recorded.start(queue)
    for number, image in enumerate(images):
        frame = rs.software_video_frame()
        frame.pixels, frame.stride, frame.bpp = image.depth_mm.copy(), 2 * lens.width, 2
        frame.timestamp, frame.frame_number = 1000 * image.time_s, number + 1
        frame.domain, frame.depth_units = rs.timestamp_domain.hardware_clock, 0.001
        frame.profile = profile.as_video_stream_profile()
        sensor.on_video_frame(frame)
        time.sleep(0.01)  # for the recorder's thread
    recorded.stop()
    recorded.close()
    return [queue.poll_for_frame() for _ in images]


def main(file, recording):
    import pyrealsense2 as rs

    given = np.load(file)
    camera = types.SimpleNamespace(**dict(zip(("fx", "fy", "cx", "cy"), given["camera"])))
    images = [types.SimpleNamespace(depth_mm=depth_mm, time_s=float(time_s), camera=camera)
              for depth_mm, time_s in zip(given["depth_mm"], given["times_s"])]  # fmt: skip
    record_realsense(rs, images, recording)


if __name__ == "__main__":
    main(*sys.argv[1:])
