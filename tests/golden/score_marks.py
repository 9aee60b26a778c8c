#!/usr/bin/env python3
"""How far the joints of a tracked recording lie from marks made by eye, across the line of sight.

  ossa track FRAMES --method none --smoothing none --posture raw --out joints.jsonl
  tests/golden/score_marks.py joints.jsonl

Of several recordings the first is of frame 0, the next of frame 1: stills, each tracked alone.
"""
import argparse
import json
import math
import pathlib

FOCAL_PX, CENTRE_U, CENTRE_V = 575.0, 320.0, 240.0  # a Kinect v1


def distance_m(joint, u, v):
    x, y, z = joint["p"]
    across = CENTRE_U - FOCAL_PX * x / z - u
    along = CENTRE_V - FOCAL_PX * y / z - v
    return math.hypot(across, along) * z / FOCAL_PX


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recordings", nargs="+", type=pathlib.Path, help="skeletons, .jsonl")
    parser.add_argument("--marks", type=pathlib.Path,
                        default=pathlib.Path(__file__).with_name("kinect_marks.txt"))
    arguments = parser.parse_args()
    frames = {}
    for index, recording in enumerate(arguments.recordings):
        for line in recording.read_text().splitlines():
            frame = json.loads(line)
            number = frame["frame"] if len(arguments.recordings) == 1 else index
            frames[number] = frame.get("bodies", [])
    distances = []
    for line in arguments.marks.read_text().splitlines():
        if line.startswith("#"):
            continue
        frame, name, u, v = line.split()
        found = [distance_m(body["joints"][name], float(u), float(v))
                 for body in frames.get(int(frame), [])
                 if name in body["joints"] and "p" in body["joints"][name]]
        distances.append(min(found, default=math.inf))
        if distances[-1] > 0.1:
            print(f"frame {frame} {name}: {100 * distances[-1]:.0f} cm")
    for limit_m in (0.05, 0.1):
        share = sum(d <= limit_m for d in distances) / len(distances)
        print(f"within {100 * limit_m:.0f} cm: {100 * share:.1f} % of {len(distances)} marks")
    finite = [d for d in distances if math.isfinite(d)]
    if finite:
        print(f"mean of the {len(finite)} found: {100 * sum(finite) / len(finite):.2f} cm")


if __name__ == "__main__":
    main()
