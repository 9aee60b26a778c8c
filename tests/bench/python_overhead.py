#!/usr/bin/env python3
"""The overhead of tracking from Python over `ossa track`, in the same run.

Usage: PYTHONPATH=BUILD/python python_overhead.py OSSA SOURCE [ROUNDS]

Runs the command and the same in Python in turns, as whole programs that read SOURCE, track it and write
the skeletons, and prints the processor time of both outside of the kernel, which a machine that is busy
elsewhere changes least. The start is subtracted: of both, the median time for the first frame alone. NumPy's
BLAS has one thread: its others turn idly for some time after the import, now more, now less.
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
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    ossa, source = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    starts, wholes = ({"ossa track": [], "Python": []} for _ in range(2))
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "skeletons.jsonl")
        for _ in range(rounds):
            for frames, times in ((1, starts), (10**9, wholes)):
                command = (ossa, "track", source, "--out", out, "--quiet", "--frames", str(frames))
                times["ossa track"].append(processor_s(*command))
                lines = open(out, "rb").read()
                times["Python"].append(processor_s(sys.executable, "-c", PROGRAM, source, out, str(frames)))
                if open(out, "rb").read() != lines:
                    sys.exit("the skeletons differ")
    count = lines.count(b"\n") - 1
    cost = {}
    for name, values in wholes.items():
        start = statistics.median(starts[name])
        cost[name] = [1000 * (pick(values) - start) / count for pick in (statistics.median, min, max)]
        of = cost[name]
        print(f"{name}: {of[0]:.2f} ms a frame ({of[1]:.2f} to {of[2]:.2f}; {count} frames, {rounds} rounds)")
    for i, name in enumerate(("median", "fastest")):
        print(f"Python costs {100 * (cost['Python'][i] / cost['ossa track'][i] - 1):+.1f} % by the {name}")


if __name__ == "__main__":
    main()
