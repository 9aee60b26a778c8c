"""Depth, points, users and skeletons over time in rerun's viewer (pip install rerun-sdk).

Usage: rerun_sink.py SOURCE [OUT.rrd]    opens the viewer, or writes a file for it
"""

import sys

import numpy as np
import rerun as rr

import ossa

BONES = [(parent, joint) for joint, parent in enumerate(ossa.PARENTS) if parent >= 0]


def log(frame, depth_mm, camera):
    """Sends one frame to rerun; its camera space has x to the right and y down."""
    rr.set_time("time", duration=frame.time_s)
    height, width = depth_mm.shape
    rr.log("camera", rr.Pinhole(focal_length=(camera.fx, camera.fy), width=width, height=height,
                                principal_point=(camera.cx, camera.cy)))
    rr.log("camera/depth", rr.DepthImage(depth_mm, meter=1000.0))
    rr.log("camera/users", rr.SegmentationImage(frame.users))
    points = camera.points(depth_mm)
    flip = np.array([-1, -1, 1])
    seen = (depth_mm > 0) & (frame.users > 0)
    rr.log("points", rr.Points3D(points[seen] * flip, class_ids=frame.users[seen]))
    rr.log("people", rr.Clear(recursive=True))
    for body in frame.bodies:
        joints = body.joints * flip
        rr.log(f"people/{body.id}/bones", rr.LineStrips3D([joints[[a, b]] for a, b in BONES]))
        rr.log(f"people/{body.id}/joints", rr.Points3D(joints, labels=list(ossa.JOINTS)))


if __name__ == "__main__":
    rr.init("ossa", spawn=len(sys.argv) < 3)
    if len(sys.argv) > 2:
        rr.save(sys.argv[2])
    tracker = ossa.Tracker()
    for depth_mm, camera, time_s in ossa.open(sys.argv[1]):
        log(tracker.track(depth_mm, camera, time_s), depth_mm, camera)
