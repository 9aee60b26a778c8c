"""Names of joints, parts and methods."""

from __future__ import annotations

import enum

from . import _native

JOINTS: tuple[str, ...] = _native.joints
"""Names of the 20 joints in the Kinect SDK's order: index j of every array of joints."""

PARENTS: tuple[int, ...] = _native.parents
"""Index of each joint's parent, -1 of the root; the 19 others are the bones."""

PARTS: tuple[str, ...] = _native.parts
"""Names of the labels of part images: 0 background, 1 to 31 body parts, 32 any object held."""

METHODS: tuple[str, ...] = tuple(str(row["name"]) for row in _native.methods)
"""Names of reconstruction methods, for Tracker and reconstruct."""

CAMERA_PRESETS: tuple[str, ...] = _native.camera_presets
"""Names of cameras, for Camera.preset."""

SMOOTHINGS: tuple[str, ...] = _native.smoothing_presets
"""Presets of the final filter of joints."""

SKELETON_FORMATS: tuple[str, ...] = _native.skeleton_formats
"""Formats that read_skeletons recognises by content."""

MOUNTS: tuple[str, ...] = ("auto", "level", "ceiling")
"""Mountings of a camera, for Tracker(mount=...)."""

STATES: tuple[str, ...] = ("not_tracked", "inferred", "tracked")
"""States of a joint: seen in the image (tracked), estimated from its surroundings (inferred),
or merely plausible for the rest of the body (not_tracked)."""


SEGMENTS: tuple[str, ...] = (
    "Pelvis", "Abdomen", "Chest", "Head",
    "CollarLeft", "UpperArmLeft", "ForearmLeft", "HandLeft",
    "CollarRight", "UpperArmRight", "ForearmRight", "HandRight",
    "ThighLeft", "ShankLeft", "FootLeft", "ThighRight", "ShankRight", "FootRight",
)  # fmt: skip
"""The rigid segments of the body that is fitted to the depth image."""


class Joint(enum.IntEnum):
    """The 20 joints by name, for indexing: body.joints[ossa.Joint.Head]. Left is the person's."""

    HipCenter = 0
    Spine = 1
    ShoulderCenter = 2
    Head = 3
    ShoulderLeft = 4
    ElbowLeft = 5
    WristLeft = 6
    HandLeft = 7
    ShoulderRight = 8
    ElbowRight = 9
    WristRight = 10
    HandRight = 11
    HipLeft = 12
    KneeLeft = 13
    AnkleLeft = 14
    FootLeft = 15
    HipRight = 16
    KneeRight = 17
    AnkleRight = 18
    FootRight = 19
