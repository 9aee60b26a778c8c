"""Body parts and skeleton of one depth image, in ten lines.

Usage: parts_of_a_picture.py DEPTH.png OUT.png    a 16-bit PNG in millimetres, or a folder of them
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import ossa

depth_mm, camera, time_s = next(ossa.open(sys.argv[1]))
frame = ossa.Tracker().track(depth_mm, camera, time_s)
plt.imshow(depth_mm, cmap="gray")
plt.imshow(frame.parts, cmap="nipy_spectral", alpha=(frame.parts > 0) * 0.6)
for body in frame.bodies:
    u, v = camera.project(body.joints).T
    for joint, parent in enumerate(ossa.PARENTS):
        if parent >= 0:
            plt.plot(u[[parent, joint]], v[[parent, joint]], "w-o", markersize=3)
plt.savefig(sys.argv[2], dpi=150)
