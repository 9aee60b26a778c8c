"""ossa: depth images in, human skeletons out, as NumPy arrays.

    import ossa
    tracker = ossa.Tracker()
    for depth_mm, camera, time_s in ossa.open("recording.oni"):
        frame = tracker.track(depth_mm, camera, time_s)
        for body in frame.bodies:
            print(time_s, body.id, body["Head"])

Tracker           depth images to bodies; its results are Frame, Body, Fit, Mesh, Proposals
Camera            intrinsics of a depth camera; Camera.preset("kinect-v2")
open              any SOURCE of `ossa track`: devices, .oni, .mkv, bags of ROS, PNG folders
write_images      a camera's images for `ossa track -` and `ossa view -`
Forest            body parts and probabilities of one image
Sequence          recorded skeletons: read_skeletons, read_recordings, write_skeletons
reconstruct       methods that make recorded skeletons complete and plausible
compare           results against truth; evaluate: forests; learn: a sensor's errors
JOINTS, PARENTS, PARTS, SEGMENTS, METHODS, STATES, CAMERA_PRESETS, SMOOTHINGS, SKELETON_FORMATS:
    constants

Camera space is metres, right-handed, origin at the sensor, x to the sensor's left, y up, z forward.
Depth is uint16 [height, width] in millimetres, 0 = no reading. Quaternions are w x y z. Left is the
person's left. Invalid arguments raise ossa.InputError, a ValueError with a message of one line.
help(ossa.Tracker) and so on describe every argument.
"""

from ._camera import Camera
from ._evaluation import Comparison, compare, evaluate, learn
from ._forest import Forest
from ._frames import Body, Fit, Frame, Mesh, Proposals, Thing
from ._models import Models
from ._names import (
    CAMERA_PRESETS,
    JOINTS,
    METHODS,
    PARENTS,
    PARTS,
    SEGMENTS,
    SKELETON_FORMATS,
    SMOOTHINGS,
    STATES,
    Joint,
)
from ._native import InputError
from ._native import version as __version__
from ._pipe import write_images
from ._reconstruct import reconstruct
from ._sequences import Sequence
from ._skeleton_files import read_recordings, read_skeletons, write_skeletons
from ._sources import DepthImage, Source, open
from ._smoothing import Holt, OneEuro
from ._tracker import Tracker

__all__ = [
    "Body",
    "CAMERA_PRESETS",
    "Camera",
    "Comparison",
    "DepthImage",
    "Fit",
    "Forest",
    "Frame",
    "Holt",
    "InputError",
    "JOINTS",
    "Joint",
    "METHODS",
    "Mesh",
    "Models",
    "OneEuro",
    "PARENTS",
    "PARTS",
    "Proposals",
    "SEGMENTS",
    "SKELETON_FORMATS",
    "SMOOTHINGS",
    "STATES",
    "Sequence",
    "Source",
    "Thing",
    "Tracker",
    "__version__",
    "compare",
    "evaluate",
    "learn",
    "open",
    "read_recordings",
    "read_skeletons",
    "reconstruct",
    "write_images",
    "write_skeletons",
]
