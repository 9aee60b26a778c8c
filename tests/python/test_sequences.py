"""ossa.Sequence: its files, methods on it and its evaluation."""

import json
import subprocess
import sys

import numpy as np
import pytest

import ossa


@pytest.fixture
def truth(clip):
    return ossa.read_skeletons(clip / "truth.jsonl")


@pytest.fixture
def seen(frames):
    return ossa.Sequence.from_frames(frames)


def two_people():
    joints = np.zeros((3, 20, 3))
    joints[:, :, 1] = np.arange(20) * 0.05
    joints[:, :, 2] = 2
    joints[1, 3] = np.nan
    return ossa.Sequence([0, 0, 0.1], joints, ids=[1, 2, 1])


def test_read_returns_a_row_per_body_and_frame(truth):
    assert len(truth) == 24 and truth.joints.shape == (24, 20, 3) and truth.people == [1]
    assert truth.times[1] == pytest.approx(1 / 30, abs=1e-3)


@pytest.mark.parametrize("extension", ["jsonl", "csv"])
def test_written_files_are_read_back(extension, tmp_path):
    made = two_people()
    ossa.write_skeletons(made, tmp_path / f"a.{extension}")
    read = ossa.read_skeletons(tmp_path / f"a.{extension}")
    assert np.allclose(read.joints, made.joints, atol=1e-4, equal_nan=True)
    assert list(read.ids) == [1, 2, 1] and list(read.frames) == [0, 0, 1]


def test_files_keep_every_field_of_the_tracker(seen, tmp_path):
    ossa.write_skeletons(seen, tmp_path / "a.jsonl")
    read = ossa.read_skeletons(tmp_path / "a.jsonl")
    assert (read.states == seen.states).all()
    for name in ("joints", "times", "confidence", "reliability", "orientations", "floor"):
        # Files hold six digits.
        assert np.allclose(getattr(read, name), getattr(seen, name), atol=1e-5), name


def test_rows_can_be_iterated():
    assert [list(row.ids) for row in two_people()] == [[1], [2], [1]]


def test_person_and_time_span_are_selected():
    made = two_people()
    assert list(made.person(1).times) == [0, 0.1]
    assert len(made[1:]) == 2 and made[1:].people == [1, 2]
    with pytest.raises(ossa.InputError, match="expected one of"):
        made.person(3)


def test_frames_without_bodies_are_kept(tmp_path):
    joints = np.full((2, 20, 3), np.nan)
    ossa.write_skeletons(ossa.Sequence([0, 1], joints, ids=[-1, -1]), tmp_path / "a.jsonl")
    assert (tmp_path / "a.jsonl").read_text().count('"bodies":[]') == 2


@pytest.mark.parametrize("method", ["none", "best", "kalman", "shum-2013"])
def test_reconstruct_equals_the_command(method, seen, command, tmp_path):
    ossa.write_skeletons(seen, tmp_path / "seen.jsonl")
    command("reconstruct", tmp_path / "seen.jsonl", "--method", method, "--out",
            tmp_path / "command.jsonl", "--quiet")  # fmt: skip
    read = ossa.read_skeletons(tmp_path / "seen.jsonl")
    ossa.write_skeletons(ossa.reconstruct(read, method), tmp_path / "python.jsonl")
    assert (tmp_path / "python.jsonl").read_bytes() == (tmp_path / "command.jsonl").read_bytes()


def test_absent_joints_are_reconstructed_and_marked_inferred(truth):
    truth.joints[:, ossa.Joint.HandLeft] = np.nan
    made = ossa.reconstruct(truth)
    assert np.isfinite(made.joints).all()
    assert (made.states[:, ossa.Joint.HandLeft] == "inferred").all()


def test_reconstruct_offers_butterworth_and_bones_of_the_recording(truth):
    assert len(ossa.reconstruct(truth, "butterworth", cutoff_hz=3)) == 24
    made = ossa.reconstruct(truth, bones="recording")
    arm = np.linalg.norm(made.joints[:, 5] - made.joints[:, 4], axis=1)
    assert np.ptp(arm) < 1e-6


def test_reconstruct_smooths_the_whole_recording_by_default(seen):
    rough, usual, whole = (ossa.reconstruct(seen, lag=lag) for lag in (0, None, "whole"))
    assert np.array_equal(usual.joints, whole.joints)
    jumps = [np.abs(np.diff(s.joints, 2, axis=0)).mean() for s in (rough, whole)]
    assert jumps[1] < jumps[0]
    for wrong in (3, -1, "half"):
        with pytest.raises(ossa.InputError):
            ossa.reconstruct(seen, lag=wrong)


def test_compare_returns_the_fields_of_the_command(clip, seen, command, tmp_path):
    ossa.write_skeletons(seen, tmp_path / "seen.jsonl")
    by_command = json.loads(
        command("compare", clip / "truth.jsonl", tmp_path / "seen.jsonl", "--json", "-")
    )
    by_python = ossa.compare(clip / "truth.jsonl", tmp_path / "seen.jsonl")
    assert by_python == by_command
    in_memory = ossa.compare(ossa.read_skeletons(clip / "truth.jsonl"), seen)
    assert in_memory["results"][0]["name"] == "result"
    ours, theirs = in_memory["results"][0], by_command["results"][0]
    assert ours["mean_joint_error_cm"] == pytest.approx(theirs["mean_joint_error_cm"])


def test_compare_and_learn_use_frame_s_for_files_without_times(truth, seen, tmp_path):
    table = tmp_path / "seen.txt"
    lines = ["FRAME JOINT x y z"]
    for frame, joints in enumerate(truth.joints):
        named = zip(ossa.JOINTS, joints)
        lines += [f"{frame} {name} {p[0]:.6f} {p[1]:.6f} {p[2]:.6f}" for name, p in named]
    table.write_text("\n".join(lines) + "\n")
    slow = ossa.Sequence(np.arange(len(truth)) / 12.5, truth.joints)
    judged = ossa.compare(slow, table, time="none", frame_s=1 / 12.5)["results"][0]
    assert judged["frames"] == len(truth)
    assert judged["mean_joint_error_cm"] == pytest.approx(0, abs=1e-3)
    learned = ossa.learn(table, slow, tmp_path / "x.ossagp", correction_only=True, frame_s=1 / 12.5)
    assert learned["pairs"] == len(truth)
    with pytest.raises(ossa.InputError, match="frame_s"):
        ossa.compare(slow, table, frame_s=0)


def test_evaluate_returns_the_fields_of_the_command(clip, command):
    model = clip.parents[3] / "tools/tracker/shipped/body.ossa"
    by_command = json.loads(command("evaluate", model, clip, "--every", 8, "--quiet"))
    by_python = ossa.evaluate(model, clip, every=8)
    assert by_python.keys() == by_command.keys()
    assert by_python["pixel_accuracy"] == by_command["pixel_accuracy"]


def test_learn_writes_a_file_that_reconstruct_reads(truth, seen, tmp_path):
    learned = ossa.learn(seen, truth, tmp_path / "own.ossagp", correction_only=True)
    assert learned["pairs"] == 24
    made = ossa.reconstruct(seen, learned=tmp_path / "own.ossagp")
    assert np.abs(made.joints - ossa.reconstruct(seen, learned="none").joints).max() > 1e-6


def test_learn_logs_that_a_clock_is_not_the_truths(tmp_path, caplog):
    """Joints that swing at uneven intervals, and the same half a second later."""
    times = np.arange(240) / 30
    phase = np.cumsum(0.1 + 0.08 * np.sin(times))

    def swinging(phase):
        joints = np.repeat(two_people().joints[:1], len(phase), axis=0)
        joints[:, ::2, 0] += 0.2 * np.sin(phase)[:, None]
        return joints

    late = ossa.Sequence(times[:-15], swinging(phase[15:]))
    truth = ossa.Sequence(times, swinging(phase))
    ossa.learn(late, truth, tmp_path / "x.ossagp", correction_only=True)
    assert any("added to its times" in record.getMessage() for record in caplog.records)
    caplog.clear()
    ossa.learn(late, truth, tmp_path / "x.ossagp", correction_only=True, time="correlate")
    assert not caplog.records
    with pytest.raises(ossa.InputError, match="time: expected"):
        ossa.learn(late, truth, tmp_path / "x.ossagp", time="always")


def test_reconstruct_logs_times_that_cannot_be_seconds(seen, caplog):
    ossa.reconstruct(ossa.Sequence(1000 * seen.times, seen.joints), "one-euro")
    [warning] = caplog.records
    assert warning.getMessage().startswith("sequence: its frames are ")
    caplog.clear()
    ossa.reconstruct(ossa.Sequence(seen.times, seen.joints), "one-euro")
    assert not caplog.records


def test_learned_methods_need_their_file(seen):
    with pytest.raises(ossa.InputError, match="learned: expected the .ossagp file"):
        ossa.reconstruct(seen, "liu-2016")


def test_tables_are_data_frames_of_pandas(seen, frames, truth):
    pytest.importorskip("pandas")
    table = seen.to_pandas()
    assert len(table) == 24 * 20 and set(table["joint"]) == set(ossa.JOINTS)
    assert len(frames[0].to_pandas()) == 20
    assert ossa.compare(truth, seen).to_pandas()["mean_joint_error_cm"][0] > 0


def test_missing_pandas_is_named(tmp_path):
    (tmp_path / "pandas.py").write_text("raise ImportError")
    code = "import ossa, numpy; ossa.Sequence([0], numpy.zeros((1, 20, 3))).to_pandas()"
    environment = {"PYTHONPATH": f"{tmp_path}:{':'.join(sys.path)}"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True)
    assert b"needs the package pandas" in done.stderr


def test_import_loads_numpy_only():
    code = "import sys, ossa; print([m for m in ('pandas', 'cv2', 'rerun') if m in sys.modules])"
    assert subprocess.check_output([sys.executable, "-c", code]).strip() == b"[]"
