"""A motion made by hand for the tests of NiTE's interface: somebody stands, waves with the right hand, shows
psi, crosses the hands, and clicks with the right hand. write_bvh() puts it down as a BVH that `ossa render` plays.

A BVH's axes: centimetres, y up, the person faces +z, the left is +x.
"""
import math

RATE_HZ = 30
DOWN, BACK = (0.18, -1.0, 0.03), (0.15, -1.0, 0.15)
# Time in seconds -> right upper arm, right forearm, left upper arm, left forearm, each as (outwards, up, forwards).
KEYS = [
    (0.0, DOWN, BACK, DOWN, BACK),
    (1.0, DOWN, BACK, DOWN, BACK),
    (1.6, (0.7, -0.6, 0.35), (0.35, 1.0, 0.2), DOWN, BACK),
    *[(1.6 + 0.35 * i, (0.7, -0.6, 0.35), (0.55 if i % 2 else -0.35, 1.0, 0.2), DOWN, BACK) for i in range(1, 9)],
    (5.0, DOWN, BACK, DOWN, BACK),
    (5.6, DOWN, BACK, DOWN, BACK),
    (6.3, (1.0, 0.0, 0.05), (0.0, 1.0, 0.1), (1.0, 0.0, 0.05), (0.0, 1.0, 0.1)),
    (7.8, (1.0, 0.0, 0.05), (0.0, 1.0, 0.1), (1.0, 0.0, 0.05), (0.0, 1.0, 0.1)),
    (8.5, DOWN, BACK, DOWN, BACK),
    (9.2, (-0.05, -0.75, 0.6), (-0.85, 0.5, 0.1), (-0.05, -0.8, 0.45), (-0.85, 0.6, 0.0)),
    (10.4, (-0.05, -0.75, 0.6), (-0.85, 0.5, 0.1), (-0.05, -0.8, 0.45), (-0.85, 0.6, 0.0)),
    (11.1, DOWN, BACK, DOWN, BACK),
    (11.8, (0.5, -0.8, -0.3), (0.05, 0.4, 0.9), DOWN, BACK),
    (12.3, (0.5, -0.8, -0.3), (0.05, 0.4, 0.9), DOWN, BACK),
    (12.6, (0.25, -0.3, 0.9), (0.0, 0.05, 1.0), DOWN, BACK),
    (12.95, (0.5, -0.8, -0.3), (0.05, 0.4, 0.9), DOWN, BACK),
    (13.3, (0.5, -0.8, -0.3), (0.05, 0.4, 0.9), DOWN, BACK),
    (13.9, DOWN, BACK, DOWN, BACK),
]
# name, parent, offset; the arms rest stretched out to the sides.
JOINTS = [
    ("Hips", None, (0, 95, 0)),
    ("LeftUpLeg", "Hips", (9, -5, 0)), ("LeftLeg", "LeftUpLeg", (0, -42, 0)), ("LeftFoot", "LeftLeg", (0, -41, 0)),
    ("RightUpLeg", "Hips", (-9, -5, 0)), ("RightLeg", "RightUpLeg", (0, -42, 0)),
    ("RightFoot", "RightLeg", (0, -41, 0)),
    ("Spine", "Hips", (0, 10, 0)), ("Spine1", "Spine", (0, 15, 0)), ("Neck", "Spine1", (0, 25, 0)),
    ("Head", "Neck", (0, 10, 0)),
    ("LeftShoulder", "Spine1", (3, 21, 0)), ("LeftArm", "LeftShoulder", (14, 0, 0)),
    ("LeftForeArm", "LeftArm", (28, 0, 0)), ("LeftHand", "LeftForeArm", (25, 0, 0)),
    ("RightShoulder", "Spine1", (-3, 21, 0)), ("RightArm", "RightShoulder", (-14, 0, 0)),
    ("RightForeArm", "RightArm", (-28, 0, 0)), ("RightHand", "RightForeArm", (-25, 0, 0)),
]
ENDS = {"LeftFoot": (0, -5, 14), "RightFoot": (0, -5, 14), "Head": (0, 18, 0), "LeftHand": (9, 0, 0),
        "RightHand": (-9, 0, 0)}


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turn_between(a, b):
    """The smallest rotation of unit vector a to b, as rows of a matrix."""
    c, axis = sum(x * y for x, y in zip(a, b)), cross(a, b)
    k = [[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]]
    square = product(k, k)
    return [[(i == j) + k[i][j] + square[i][j] / (1 + c) for j in range(3)] for i in range(3)]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [list(row) for row in zip(*a)]


def degrees_zxy(r):
    """Angles about z, x, y, composed in this order."""
    x = math.asin(max(-1.0, min(1.0, r[2][1])))
    return [math.degrees(a) for a in (math.atan2(-r[0][1], r[1][1]), x, math.atan2(-r[2][0], r[2][2]))]


def directions_at(time_s):
    before = max((k for k in KEYS if k[0] <= time_s), key=lambda k: k[0])
    after = min((k for k in KEYS if k[0] > time_s), key=lambda k: k[0], default=before)
    part = (time_s - before[0]) / (after[0] - before[0]) if after is not before else 0.0
    part = part * part * (3 - 2 * part)
    return [unit([(1 - part) * a + part * b for a, b in zip(unit(u), unit(v))]) for u, v in zip(before[1:], after[1:])]


def arm_angles(side, upper, fore):
    """Joint name -> angles, of an arm whose bones point outwards, up and forwards so far."""
    sign = 1 if side == "Left" else -1
    rest = (sign, 0, 0)
    upper, fore = ((sign * d[0], d[1], d[2]) for d in (upper, fore))
    arm = turn_between(rest, upper)
    forearm = product(product(transposed(arm), turn_between(upper, fore)), arm)
    return {side + "Arm": degrees_zxy(arm), side + "ForeArm": degrees_zxy(forearm)}


def frame_values(time_s):
    right_upper, right_fore, left_upper, left_fore = directions_at(time_s)
    angles = {**arm_angles("Right", right_upper, right_fore), **arm_angles("Left", left_upper, left_fore)}
    values = list(JOINTS[0][2])
    for name, _, _ in JOINTS:
        values += angles.get(name, [0.0, 0.0, 0.0])
    return values


def hierarchy(name, indent=""):
    offset = next(o for n, _, o in JOINTS if n == name)
    root = name == "Hips"
    place = "Xposition Yposition Zposition " if root else ""
    lines = [f"{indent}{'ROOT' if root else 'JOINT'} {name}", indent + "{",
             f"{indent}  OFFSET {' '.join(map(str, (0, 0, 0) if root else offset))}",
             f"{indent}  CHANNELS {6 if root else 3} {place}Zrotation Xrotation Yrotation"]
    for child, parent, _ in JOINTS:
        if parent == name:
            lines += hierarchy(child, indent + "  ")
    if name in ENDS:
        lines += [f"{indent}  End Site", indent + "  {", f"{indent}    OFFSET {' '.join(map(str, ENDS[name]))}",
                  indent + "  }"]
    return lines + [indent + "}"]


def frame_count():
    return int(KEYS[-1][0] * RATE_HZ) + 1


def write_bvh(path):
    frames = [frame_values(i / RATE_HZ) for i in range(frame_count())]
    text = ["HIERARCHY", *hierarchy("Hips"), "MOTION", f"Frames: {len(frames)}", f"Frame Time: {1 / RATE_HZ:.7f}"]
    text += [" ".join(f"{v:.4f}" for v in values) for values in frames]
    path.write_text("\n".join(text) + "\n")
