#!/usr/bin/env python3
"""What tracking from Python costs beside `ossa track`, in the same run.

Usage: PYTHONPATH=BUILD/python python_overhead.py OSSA SOURCE [ROUNDS]

Runs the command and the same in Python in turns, as whole programs that read SOURCE, track it and write
the skeletons, and prints the processor time of both outside of the kernel, which a machine that is busy
elsewhere changes least. The start is taken off: of both, the time for the first frame alone.
"""
import os
import resource
import statistics
import subprocess
import sys
import tempfile

PROGRAM = """
import itertools, sys, ossa
source, out, frames = sys.argv[1], sys.argv[2], int(sys.argv[3])
tracked = itertools.islice(ossa.Tracker().run(source), frames)
ossa.write_skeletons(ossa.Sequence.from_frames(tracked), out)
"""


def processor_s(*command):
    """User seconds of a program."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def main():
    ossa, source = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    times = {"ossa track": [], "Python": []}
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "skeletons.jsonl")
        for _ in range(rounds):
            for frames, sign in ((1, -1), (10**9, 1)):
                command = processor_s(ossa, "track", source, "--out", out, "--quiet", "--frames", str(frames))
                lines = open(out, "rb").read()
                python = processor_s(sys.executable, "-c", PROGRAM, source, out, str(frames))
                if open(out, "rb").read() != lines:
                    sys.exit("the skeletons differ")
                if sign < 0:
                    start = {"ossa track": command, "Python": python}
            times["ossa track"].append(command - start["ossa track"])
            times["Python"].append(python - start["Python"])
    count = lines.count(b"\n") - 1
    for name, values in times.items():
        of = [1000 * pick(values) / count for pick in (statistics.median, min, max)]
        print(f"{name}: {of[0]:.2f} ms a frame ({of[1]:.2f} to {of[2]:.2f}; {count} frames, {rounds} rounds)")
    for name, pick in (("median", statistics.median), ("fastest", min)):
        more = pick(times["Python"]) / pick(times["ossa track"]) - 1
        print(f"Python costs {100 * more:+.1f} % by the {name}")


if __name__ == "__main__":
    main()
