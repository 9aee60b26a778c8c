"""The tutorials run unchanged."""

import os
import pathlib
import subprocess
import sys

import pytest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "tools/python/tutorials"


def run(name, *arguments, needs="matplotlib"):
    """What a tutorial prints."""
    pytest.importorskip(needs)
    done = subprocess.run(
        [sys.executable, FOLDER / f"{name}.py", *map(str, arguments)],
        capture_output=True, text=True, timeout=240, env={**os.environ, "MPLBACKEND": "Agg"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_parts_of_a_picture(clip, tmp_path):
    run("parts_of_a_picture", clip / "depth/000020.png", tmp_path / "parts.png")
    assert (tmp_path / "parts.png").stat().st_size > 20000


def test_errors_of_a_recording(clip, command, tmp_path):
    command("track", clip, "--out", tmp_path / "seen.jsonl", "--quiet")
    printed = run(
        "errors_of_a_recording", clip / "truth.jsonl", tmp_path / "seen.jsonl",
        tmp_path / "errors.csv", tmp_path / "errors.png",
    )  # fmt: skip
    assert printed.count(" cm\n") == 3
    rows = (tmp_path / "errors.csv").read_text().splitlines()
    assert len(rows) == 4 and float(rows[1].split(",")[1]) < 10
    assert (tmp_path / "errors.png").stat().st_size > 10000


def test_evaluate_a_forest(clip, tmp_path):
    model = clip.parents[3] / "tools/tracker/shipped/body.ossa"
    printed = run("evaluate_a_forest", model, clip, tmp_path / "forest.png")
    assert "3 images" in printed and (tmp_path / "forest.png").stat().st_size > 10000


def test_live_window(clip):
    run("live_window", clip)


def test_rerun_sink(clip, tmp_path):
    run("rerun_sink", clip, tmp_path / "clip.rrd", needs="rerun")
    assert (tmp_path / "clip.rrd").stat().st_size > 100000
