"""Skeleton files of an SDK to a table and a plot of errors.

Usage: errors_of_a_recording.py TRUTH RECORDED OUT.csv OUT.png    any two files `ossa compare` reads

Reads both, makes the recorded skeletons complete by two methods, compares all with the truth, writes
the table, and plots each joint's error.
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import ossa

truth = ossa.read_skeletons(sys.argv[1])
recorded = ossa.read_skeletons(sys.argv[2])
print(f"{recorded}: {recorded.times[-1] - recorded.times[0]:.1f} s, people {recorded.people}")

made = {"as recorded": recorded}
for method in ("kalman", "best"):
    made[method] = ossa.reconstruct(recorded, method)
results = ossa.compare(truth, list(made.values()))["results"]

with open(sys.argv[3], "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["result", "mean_cm", *ossa.JOINTS])
    for name, result in zip(made, results):
        of_joint = result["per_joint_cm"]
        table.writerow([name, result["mean_joint_error_cm"], *(of_joint.get(j) for j in ossa.JOINTS)])
        print(f"{name}: {result['mean_joint_error_cm']:.2f} cm")

for name, result in zip(made, results):
    errors = [result["per_joint_cm"].get(joint) or float("nan") for joint in ossa.JOINTS]
    plt.plot(errors, "o-", label=name)
plt.xticks(range(len(ossa.JOINTS)), ossa.JOINTS, rotation=90)
plt.ylabel("mean error, cm")
plt.ylim(bottom=0)
plt.legend()
plt.tight_layout()
plt.savefig(sys.argv[4], dpi=150)
