"""A live window: depth, users and skeletons as they come. Close it, or press Ctrl-C, to end.

Usage: live_window.py [SOURCE]    "openni:" (the first device) or anything that ossa.open takes
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import ossa

tracker = ossa.Tracker()
figure, axis = plt.subplots(num="ossa")
picture = bones = None
for depth_mm, camera, time_s in ossa.open(sys.argv[1] if len(sys.argv) > 1 else "openni:"):
    frame = tracker.track(depth_mm, camera, time_s)
    grey = np.repeat((np.clip(depth_mm / 5000, 0, 1) * 255).astype(np.uint8)[..., None], 3, axis=2)
    grey[frame.users > 0, frame.users[frame.users > 0] % 3] = 255  # a colour for each person
    if picture is None:
        picture = axis.imshow(grey)
        (bones,) = axis.plot([], [], "w-o", markersize=3)
    picture.set_data(grey)
    lines = [np.empty((0, 2))]
    for body in frame.bodies:
        places = camera.project(body.joints)
        for joint, parent in enumerate(ossa.PARENTS):
            if parent >= 0:
                lines += [places[[parent, joint]], np.full((1, 2), np.nan)]
    bones.set_data(*np.concatenate(lines).T)
    axis.set_title(f"{len(frame.bodies)} people, {frame.ms['total']:.0f} ms")
    plt.pause(0.001)
    if not plt.fignum_exists("ossa"):
        break
