#!/usr/bin/python3
"""Reads what `ossa track` wrote as JSONL, CSV, TRC and BVH with nothing but Python's own modules, and
compares: same joints at the same places at the same times. One body is expected.

  read_outputs.py WITHOUT_EXTENSION     prints "agree N frames", or what differs and exits with 1
"""
import csv
import json
import math
import sys


def read_jsonl(path):
    frames = []
    for line in open(path):
        frame = json.loads(line)
        joints = frame["bodies"][0]["joints"] if frame["bodies"] else {}
        frames.append((frame["time_s"], {name: j["p"] for name, j in joints.items()}))
    return frames


def read_csv(path):
    frames = []
    for row in csv.DictReader(open(path, newline="")):
        joints = {}
        for column, value in row.items():
            if column.endswith("_x") and value != "":
                name = column[:-2]
                joints[name] = [float(row[name + axis]) for axis in ("_x", "_y", "_z")]
        frames.append((float(row["time_s"]), joints))
    return frames


def read_trc(path):
    """OpenSim's table of markers: five lines of header, tabs, a marker's name over its X column."""
    lines = open(path).read().split("\n")
    keys, values = lines[1].split("\t"), lines[2].split("\t")
    header = dict(zip(keys, values))
    scale = {"mm": 0.001, "m": 1.0}[header["Units"]]
    names = [name for name in lines[3].split("\t")[2:] if name]
    assert len(names) == int(header["NumMarkers"]), "NumMarkers"
    frames = []
    for line in lines[5:]:
        cells = line.split("\t")
        if not cells[0].strip():
            continue
        joints = {}
        for i, name in enumerate(names):
            place = cells[2 + 3 * i : 5 + 3 * i]
            if all(c.strip() for c in place):
                joints[name] = [scale * float(c) for c in place]
        frames.append((float(cells[1]), joints))
    assert len(frames) == int(header["NumFrames"]), "NumFrames"
    return frames


def rotation(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {
        "X": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "Y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "Z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def read_bvh_hierarchy(words):
    """Nodes (name, parent, offset, channels) and the index of the word MOTION."""
    nodes, stack, at = [], [], 0
    while words[at] != "MOTION":
        word = words[at]
        if word in ("ROOT", "JOINT"):
            nodes.append([words[at + 1], stack[-1] if stack else -1, [0, 0, 0], []])
            at += 1
        elif word == "End":
            nodes.append(["", stack[-1], [0, 0, 0], []])
            at += 1
        elif word == "{":
            stack.append(len(nodes) - 1)
        elif word == "}":
            stack.pop()
        elif word == "OFFSET":
            nodes[-1][2] = [float(w) for w in words[at + 1 : at + 4]]
            at += 3
        elif word == "CHANNELS":
            count = int(words[at + 1])
            nodes[-1][3] = words[at + 2 : at + 2 + count]
            at += 1 + count
        at += 1
    return nodes, at


def pose_bvh(nodes, row):
    """Joint positions, metres, of the channels' values of one frame: forward kinematics."""
    values, places, turns, joints = iter(row), [], [], {}
    for name, parent, offset, channels in nodes:
        place, turn = list(offset), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        for channel in channels:
            if channel.endswith("position"):
                place["XYZ".index(channel[0])] += next(values)
            else:
                turn = product(turn, rotation(channel[0], next(values)))
        if parent >= 0:
            place = [p + q for p, q in zip(places[parent], applied(turns[parent], place))]
            turn = product(turns[parent], turn)
        places.append(place)
        turns.append(turn)
        if name and "-" not in name:
            joints[name] = [0.01 * p for p in place]
    return joints


def read_bvh(path):
    """Times and joint positions of a BVH file, independently of ossa's reader."""
    words = open(path).read().split()
    nodes, at = read_bvh_hierarchy(words)
    count, step_s = int(words[at + 2]), float(words[at + 5])
    numbers = [float(w) for w in words[at + 6 :]]
    width = sum(len(node[3]) for node in nodes)
    assert len(numbers) == count * width, "as many numbers as frames times channels"
    return [(f * step_s, pose_bvh(nodes, numbers[f * width : (f + 1) * width]))
            for f in range(count)]


def distance(a, b):
    return math.sqrt(sum((p - q) ** 2 for p, q in zip(a, b)))


def compare(name, frames, truth, most_m):
    if len(frames) != len(truth):
        sys.exit(f"{name}: {len(frames)} frames, expected {len(truth)}")
    for (time_s, joints), (true_s, true_joints) in zip(frames, truth):
        if abs(time_s - true_s) > 1e-3:
            sys.exit(f"{name}: time {time_s}, expected {true_s}")
        if set(joints) != set(true_joints):
            sys.exit(f"{name}: other joints at {time_s}: {set(joints) ^ set(true_joints)}")
        for joint, place in joints.items():
            if distance(place, true_joints[joint]) > most_m:
                sys.exit(f"{name}: {joint} at {time_s}: {place}, expected {true_joints[joint]}")


def main():
    stem = sys.argv[1]
    truth = read_jsonl(stem + ".jsonl")
    if len(truth) < 2 or any(len(joints) != 20 for _, joints in truth):
        sys.exit("jsonl: expected twenty joints in every frame")
    compare("csv", read_csv(stem + ".csv"), truth, 1e-6)  # seven digits
    compare("trc", read_trc(stem + ".trc"), truth, 1e-5)  # hundredths of a millimetre
    # BVH holds bones constant and the pelvis rigid: a joint is off by what the lengths of the bones
    # up to it vary. A wrong axis, order of rotations or unit is off by far more.
    compare("bvh", read_bvh(stem + ".bvh"), truth, 0.08)
    print(f"agree {len(truth)} frames")


main()
