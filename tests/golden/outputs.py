#!/usr/bin/env python3
"""The command writes the same bytes as before for the same input.

    outputs.py OSSA [--write]

Runs OSSA (the command) on the clips beside this file and compares every output with
tests/golden/outputs.txt: a line an output, its name, SHA-256, and the mean of all its numbers, which
tells how large a difference is. --write makes that file anew; do so only for a change that is meant,
and say in the commit what changed. Times are left out.
"""
import argparse
import hashlib
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import sensor_skeleton

HERE = pathlib.Path(__file__).resolve().parent
GOLDEN = HERE / "outputs.txt"
CLIPS = {"one": HERE / "clips" / "one", "two": HERE / "clips" / "two"}
TIMES = ("ns_per_pixel", "_ms")  # how keys of `evaluate --json` end whose values are times

# Output name -> arguments; {one}, {two} are clips, {NAME} an output that was made before, {out} this one's file.
RUNS = {
    "track_best.jsonl": "track {one} --out {out}",
    "track_two_people.jsonl": "track {two} --out {out} --threads 2",
    "track_physics.jsonl": "track {one} --out {out} --physics on",
    "track_raw.jsonl": "track {one} --out {out} --posture raw",
    "track_smoothed.jsonl": "track {one} --out {out} --method none --smoothing default",
    "track_shum_2013.jsonl": "track {one} --out {out} --method shum-2013",
    "track_plantard_2016.trc": "track {one} --out {out} --method plantard-2016",
    "track_bones.bvh": "track {one} --out {out} --bones recording",
    "track_live.jsonl": "track {one} --out {out} --lag 0",
    "track_seated.csv": "track {one} --out {out} --mode seated",
    "reconstruct_best.jsonl": "reconstruct {track_raw.jsonl} --out {out}",
    "reconstruct_one_euro.jsonl": "reconstruct {track_raw.jsonl} --out {out} --method one-euro",
    "reconstruct_kalman.jsonl": "reconstruct {track_raw.jsonl} --out {out} --method kalman",
    "reconstruct_shum_ho_2012.jsonl": "reconstruct {track_raw.jsonl} --out {out} --method shum-ho-2012",
    "reconstruct_physics.bvh": "reconstruct {track_raw.jsonl} --out {out} --method shum-2013 --physics on",
    "sensor_none.jsonl": "reconstruct {sensor} --out {out} --method none",
    "sensor_holt.jsonl": "reconstruct {sensor} --out {out} --method holt",
    "sensor_butterworth.jsonl": "reconstruct {sensor} --out {out} --method butterworth",
    "sensor_best.jsonl": "reconstruct {sensor} --out {out}",
    "sensor_best_database.jsonl": "reconstruct {sensor} --out {out} --database {database}",
    "sensor_best_bones.jsonl": "reconstruct {sensor} --out {out} --bones recording",
    "sensor_shum_2013.jsonl": "reconstruct {sensor} --out {out} --method shum-2013 --steps 8 --samples 60",
    "sensor_plantard_2016.jsonl": "reconstruct {sensor} --out {out} --method plantard-2016 --steps 8 --samples 60",
    "sensor_physics.jsonl": "reconstruct {sensor} --out {out} --method shum-ho-2012 --physics on",
    "learned.ossagp": "learn --observed {sensor} --truth {sensor_truth} --out {out} --regions 4 --samples 20 --pairs 150",
    "sensor_best_learned.jsonl": "reconstruct {sensor} --out {out} --learned {learned.ossagp}",
    "sensor_liu_2016.jsonl": "reconstruct {sensor} --out {out} --method liu-2016 --learned {learned.ossagp}",
    "sensor_full_gp.jsonl": "reconstruct {sensor} --out {out} --method full-gp --learned {learned.ossagp}",
    "sensor_exemplar.jsonl": "reconstruct {sensor} --out {out} --method exemplar --learned {learned.ossagp}",
    "sensor_best.bvh": "reconstruct {sensor} --out {out} --bones recording",
    "compare_sensor.json": "compare {sensor_truth} {sensor_best.jsonl} {sensor_liu_2016.jsonl} --json {out}",
    "compare.json": "compare {one}/truth.jsonl {track_raw.jsonl} {track_best.jsonl} {track_shum_2013.jsonl} "
                    "--json {out}",
    "evaluate.json": "evaluate {model} {one} --json {out}",
}
SHIPPED = HERE.parent.parent / "tools" / "tracker" / "shipped"
MODELS = {"model": SHIPPED / "body.ossa", "database": SHIPPED / "authored.ossadb"}


def without_times(name, text):
    if name != "evaluate.json":
        return text
    figures = {key: value for key, value in json.loads(text).items() if not key.endswith(TIMES)}
    return json.dumps(figures, sort_keys=True)


def mean_of_numbers(text):
    numbers = [float(n) for n in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?(?![\w.])", text)]
    return math.fsum(numbers) / len(numbers) if numbers else 0.0


def run_all(ossa):
    with tempfile.TemporaryDirectory() as folder:
        known = {**CLIPS, **MODELS, "sensor": pathlib.Path(folder) / "sensor.jsonl",
                 "sensor_truth": pathlib.Path(folder) / "sensor_truth.jsonl"}
        sensor_skeleton.write(known["sensor_truth"], known["sensor"])
        for name, arguments in RUNS.items():
            out = pathlib.Path(folder) / name
            words = []
            for word in arguments.split():
                for key, place in [*known.items(), ("out", out)]:
                    word = word.replace("{" + key + "}", str(place))
                words.append(word)
            subprocess.run([ossa, *words, *([] if words[0] == "compare" else ["--quiet"])], check=True,
                           stdout=subprocess.DEVNULL, cwd=folder)
            known[name] = out
            text = without_times(name, out.read_bytes().decode("latin-1").replace(folder, "").replace(str(HERE), ""))
            yield f"{name} {hashlib.sha256(text.encode('latin-1')).hexdigest()} {mean_of_numbers(text):.9g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ossa")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    today = list(run_all(str(pathlib.Path(arguments.ossa).resolve())))
    if arguments.write:
        GOLDEN.write_text("\n".join(today) + "\n")
        return 0
    golden = {line.split()[0]: line for line in GOLDEN.read_text().splitlines()}
    differing = [line for line in today if golden.get(line.split()[0]) != line]
    for line in differing:
        print(f"was: {golden.get(line.split()[0], 'nothing')}\nis:  {line}")
    print(f"{len(today) - len(differing)} of {len(today)} outputs are the same")
    return 1 if differing or len(golden) != len(today) else 0


if __name__ == "__main__":
    sys.exit(main())
