"""A recording as a sensor of skeletons makes it, and the truth behind it: written anew for each run.

Two people move their limbs in sines. The sensor's joints are noisy and biased, and everything happens to them that
happens to a sensor's: joints not tracked, guessed or absent, left and right exchanged, a hand that jumps to the other
one, a frame on another body, frames without anybody, a gap in time, a second of guesses. Positions have four decimals,
so that the bytes do not depend on the last bit of a sine.
"""
import json
import math
import random

NAMES = ("HipCenter Spine ShoulderCenter Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight "
         "WristRight HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight").split()
PARENT = [-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18]
MIRRORED = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
# Bones of an adult who stands with hanging arms and faces +z, left = +x, metres.
BONE = {1: (0, 0.18, 0), 2: (0, 0.32, 0.01), 3: (0, 0.17, 0.03), 4: (0.17, -0.09, 0.01), 5: (0.16, -0.18, 0),
        6: (0.12, -0.12, 0.16), 7: (0.02, -0.03, 0.04), 12: (0.10, -0.05, 0.01), 13: (0.04, -0.39, 0.03),
        14: (0.04, -0.41, -0.01), 15: (0.01, -0.04, 0.13)}
FRAMES, FRAME_S = 210, 1 / 30


def bone(joint):
    if joint in BONE:
        return BONE[joint]
    x, y, z = BONE[MIRRORED[joint]]
    return -x, y, z


def about_x(p, angle):
    c, s = math.cos(angle), math.sin(angle)
    return p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]


def about_y(p, angle):
    c, s = math.cos(angle), math.sin(angle)
    return c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]


def swing(joint, time_s, phase):
    """How far the bone is turned about x against the one above it."""
    side = 1 if joint < 8 or 12 <= joint < 16 else -1
    if joint in (5, 9):
        return -0.5 + 0.6 * side * math.sin(2.1 * time_s + phase)
    if joint in (6, 10):
        return -0.4 + 0.4 * math.sin(1.7 * time_s + side + phase)
    if joint in (13, 17):
        return -0.3 + 0.3 * side * math.sin(1.9 * time_s + phase)
    if joint in (14, 18):
        return 0.3 + 0.25 * math.sin(1.9 * time_s + side + phase)
    return 0.1 * math.sin(time_s + phase) if joint in (1, 2) else 0.0


def posture(time_s, phase, size, root):
    turn = math.pi + 0.5 * math.sin(0.4 * time_s + phase)
    angle, place = [0.0] * 20, [(0.0, 0.0, 0.0)] * 20
    for j in range(1, 20):
        angle[j] = angle[PARENT[j]] + swing(j, time_s, phase)
        step = about_x(tuple(size * v for v in bone(j)), angle[j])
        place[j] = tuple(a + b for a, b in zip(place[PARENT[j]], step))
    drift = (0.2 * math.sin(0.5 * time_s), 0.0, 0.1 * math.sin(0.3 * time_s))
    return [tuple(a + b + c for a, b, c in zip(about_y(p, turn), root, drift)) for p in place]


def observed(truth, rng, bias):
    return [tuple(v + rng.uniform(-0.008, 0.008) + b for v, b in zip(p, bias[j])) for j, p in enumerate(truth)]


def joint_record(p, state="tracked", confidence=0.9):
    return {"p": [round(v, 4) for v in p], "state": state, "confidence": confidence}


def spoilt(frame, places, first):
    """The joints of one person as the sensor tells them; what goes wrong goes wrong with the first."""
    joints = {j: joint_record(p) for j, p in enumerate(places)}
    if not first:
        return {j: r for j, r in joints.items() if j not in (7, 11, 15, 19)}  # a sensor without hands and feet
    if 50 <= frame < 75:
        for j in (17, 18, 19):
            joints[j] = joint_record(places[j], "not_tracked", 0.0)
    if 80 <= frame < 92:
        del joints[5], joints[6]
    if 96 <= frame < 99:
        joints = {j: joint_record(places[MIRRORED[j]]) for j in joints}
    if frame in (104, 105):
        joints[6], joints[7] = joint_record(places[10]), joint_record(places[11])
    if frame == 110:
        joints = {j: joint_record((p[0] + 1.2, p[1], p[2])) for j, p in enumerate(places)}
    if 118 <= frame < 130:
        for j in (9, 10, 11):
            joints[j] = joint_record([v + 0.12 for v in places[j]], "inferred", 0.3)
    if 160 <= frame < 175:
        joints = {j: joint_record(p, "inferred", 0.4) for j, p in enumerate(places)}
    return joints


def write(truth_path, sensor_path):
    rng = random.Random(7)
    bias = [[rng.uniform(-0.03, 0.03) for _ in range(3)] for _ in range(20)]
    with open(truth_path, "w") as truth_file, open(sensor_path, "w") as sensor_file:
        for f in range(FRAMES):
            time_s = round(f * FRAME_S + 0.003 * (f % 3) + (2.0 if f >= 140 else 0.0), 4)
            true_bodies, seen_bodies = [], []
            people = [(1, 0.0, 1.05, (0.3, 0.0, 2.5))] + ([(2, 1.3, 0.7, (-0.8, -0.2, 3.1))] if f >= 30 else [])
            for name, phase, size, root in people:
                truth = posture(time_s, phase, size, root)
                seen = spoilt(f, observed(truth, rng, bias), name == 1)
                true_bodies.append({"id": name, "joints": {NAMES[j]: joint_record(p) for j, p in enumerate(truth)}})
                seen_bodies.append({"id": name, "joints": {NAMES[j]: r for j, r in seen.items()}})
            if 134 <= f < 137:
                seen_bodies = []
            for out, bodies in ((truth_file, true_bodies), (sensor_file, seen_bodies)):
                out.write(json.dumps({"frame": f, "time_s": time_s, "bodies": bodies}) + "\n")
