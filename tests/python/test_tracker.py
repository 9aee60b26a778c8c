"""ossa.Tracker: the command's skeletons as plain arrays, in any thread."""

import copy
import dataclasses
import gc
import os
import pathlib
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import ossa


SCENE = """
floor = [0, 1, 0, 1]
[[object]]
name = "crate"
shape = "box"
size_m = [0.3, 0.3, 0.3]
mass_kg = 2
at_m = [1.5, 0, 3]
"""


def skeletons_of(tracker, images):
    return [tracker.track(*image).bodies[0].joints for image in images]


@pytest.mark.parametrize("method", ["best", "holt", "shum-2013"])
def test_track_writes_the_same_bytes_as_the_command(method, clip, command, tmp_path):
    command("track", clip, "--method", method, "--out", tmp_path / "command.jsonl", "--quiet")
    # The command's defaults for a recording: best with the largest lag, others without.
    tracked = ossa.Tracker(method, lag=2 if method == "best" else 0).run(clip)
    ossa.write_skeletons(ossa.Sequence.from_frames(tracked), tmp_path / "python.jsonl")
    assert (tmp_path / "python.jsonl").read_bytes() == (tmp_path / "command.jsonl").read_bytes()


def test_times_in_milliseconds_are_logged_once(images, models, caplog):
    tracker = ossa.Tracker(models=models, fit=False)
    for depth_mm, camera, time_s in images:
        tracker.track(depth_mm, camera, 1000 * time_s)
    [warning] = caplog.records
    assert "are they milliseconds?" in warning.getMessage()


def test_tracker_warns_of_a_refinement_of_another_forest(command, tmp_path, caplog):
    # The smallest training there is, at the shipped forest's joints.
    command("render", "--mocap", "authored", "--out", tmp_path / "people", "--frames", "150",
            "--size", "160x120", "--view", "front", "--format", "packed", "--quiet")  # fmt: skip
    command("refine", tmp_path / "people", "--out", tmp_path / "a.ossarefine", "--hidden", "4",
            "--epochs", "1", "--quiet")  # fmt: skip
    ossa.Models(refinement=tmp_path / "a.ossarefine")
    assert not caplog.records
    other = pathlib.Path(__file__).parents[2] / "tools/tracker/shipped/body_ceiling.ossa"
    ossa.Models(model=other, refinement=tmp_path / "a.ossarefine")
    [warning] = caplog.records
    assert "a.ossarefine: learned at the joints of another forest" in warning.message


def test_body_fields_have_their_shape_and_type(frames):
    body = frames[-1].bodies[0]
    for name, shape in {
        "position": (3,), "joints": (20, 3), "confidence": (20,), "reliability": (20,),
        "orientations": (20, 4), "hierarchical_orientations": (20, 4), "raw": (20, 3),
        "refined": (20, 3), "reconstructed": (20, 3), "bones_m": (20,),
    }.items():  # fmt: skip
        assert getattr(body, name).shape == shape, name
        assert getattr(body, name).dtype == np.float64, name
    assert body.states.shape == (20,)
    assert set(body.states) <= set(ossa.STATES)
    assert np.allclose(np.linalg.norm(body.orientations, axis=1), 1)
    assert ((0 <= body.confidence) & (body.confidence <= 1)).all()
    assert len(body.proposals) == 20


def test_frame_fields_have_their_shape_and_type(frames):
    frame = frames[-1]
    assert frame.users.shape == frame.parts.shape == (240, 320)
    assert frame.users.dtype == frame.parts.dtype == np.uint8
    assert set(np.unique(frame.users)) == {0, frame.bodies[0].id}
    assert frame.floor.shape == (4,) and np.isclose(np.linalg.norm(frame.floor[:3]), 1)
    assert frame.probabilities.shape == (240, 320, len(ossa.PARTS))
    assert frame.probabilities.dtype == np.float32
    seen = frame.parts > 0
    assert np.allclose(frame.probabilities.sum(-1)[seen], 1, atol=1e-3)
    assert not frame.probabilities[frame.users == 0].any()


def test_best_proposal_of_a_tracked_joint_is_near_the_raw_joint(frames):
    body = frames[-1].bodies[0]
    head = body.proposals[ossa.Joint.Head]
    assert len(head) == len(head.confidence) == len(head.seen) >= 1
    assert list(head.confidence) == sorted(head.confidence, reverse=True)
    assert np.abs(head.positions - body.raw[ossa.Joint.Head]).max(axis=1).min() < 1e-9


def test_unrequested_results_are_absent(images, models):
    frame = ossa.Tracker(models=models, parts=False).track(*images[0])
    assert frame.parts is None and frame.probabilities is None
    assert all(body.proposals is None for body in frame.bodies)


def test_joints_are_accessed_by_name_and_index(frames):
    body = frames[-1].bodies[0]
    assert (body["Head"] == body.joints[ossa.JOINTS.index("Head")]).all()
    assert (body[ossa.Joint.Head] == body["Head"]).all()
    assert [j.name for j in ossa.Joint] == list(ossa.JOINTS)


def test_bodies_can_be_compared_and_unpacked(frames):
    """Bodies compare by identity: comparing arrays gives an array, not one truth value."""
    body, other = frames[-1].bodies[0], frames[-2].bodies[0]
    assert body in frames[-1].bodies and body not in frames[-2].bodies and body != other
    assert len({body, other, frames[0], frames[1]}) == 4
    assert np.array_equal(list(body), body.joints)
    again = copy.deepcopy(body)
    assert np.array_equal(again.joints, body.joints)
    assert np.array_equal(again.mesh.vertices, body.mesh.vertices)
    assert dataclasses.asdict(body)["id"] == body.id


def test_run_yields_frames_tracked_before_the_source_fails(clip, models):
    tracker, source = ossa.Tracker(models=models, lag=2), ossa.open(clip)
    numbers = []
    with pytest.raises(ossa.InputError, match="closed"):
        for frame in tracker.run(source):
            numbers.append(frame.index)
            source.close()
    assert numbers == [0, 1, 2]


def test_abandoned_run_leaves_no_frames_to_the_next(clip, models):
    tracker = ossa.Tracker(models=models, lag=2)
    for _ in tracker.run(clip):
        break
    assert next(tracker.run(ossa.open(clip))).index == 3  # of those until then


def test_results_outlive_the_tracker_and_the_next_frame(images, models):
    tracker = ossa.Tracker(models=models)
    frame = tracker.track(*images[0])
    joints, users = frame.bodies[0].joints, frame.users
    kept = joints.copy(), users.copy()
    tracker.track(*images[1])
    del tracker, frame
    gc.collect()
    assert (joints == kept[0]).all() and (users == kept[1]).all()


def test_trackers_in_threads_give_the_same_results(images, models):
    alone = skeletons_of(ossa.Tracker(models=models), images)
    made = {}

    def work(number):
        made[number] = skeletons_of(ossa.Tracker(models=models), images)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number in range(4):
        assert np.array_equal(made[number], alone)


def test_one_tracker_in_two_threads_is_serialised(images, models):
    tracker = ossa.Tracker(models=models)
    failures = []

    def work():
        try:
            for image in images:
                tracker.track(*image)
                tracker.mode = "standing"
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_tracking_releases_the_gil(images, models):
    tracker = ossa.Tracker(models=models, parts=True)
    thread = threading.Thread(target=skeletons_of, args=(tracker, images))
    thread.start()
    turns = 0
    while thread.is_alive():
        time.sleep(0.0005)  # wakes only where the interpreter is free
        turns += 1
    # An image takes 5 ms and more. With the interpreter held there is a turn or two between images.
    assert turns > 4 * len(images)


def test_image_view_is_tracked_like_its_copy(images, models):
    depth_mm, camera, _ = images[0]
    part = depth_mm[20:220, 10:310]
    assert not part.flags.c_contiguous
    cut = ossa.Camera(camera.fx, camera.fy, camera.cx - 10, camera.cy - 20)
    as_view = ossa.Tracker(models=models).track(part, cut)
    as_copy = ossa.Tracker(models=models).track(part.copy(), cut)
    assert len(as_view.bodies) == 1
    assert np.array_equal(as_view.bodies[0].joints, as_copy.bodies[0].joints)


def test_writing_into_an_image_while_tracking_does_not_crash(images, models):
    given, camera, _ = images[0]
    depth_mm = given.copy()
    tracked = threading.Event()

    def write():
        random = np.random.default_rng(1)
        while not tracked.is_set():
            depth_mm[random.random(depth_mm.shape) < 0.2] = random.choice([0, 1, 65535])
            depth_mm[:] = given

    writer = threading.Thread(target=write)
    writer.start()
    tracker = ossa.Tracker(models=models, parts=True)
    try:
        bodies = [body for _ in range(30) for body in tracker.track(depth_mm, camera).bodies]
    finally:
        tracked.set()
        writer.join()
    assert all(np.isfinite(body.joints).all() for body in bodies)
    assert np.array_equal(
        ossa.Tracker(models=models).track(depth_mm, camera).users,
        ossa.Tracker(models=models).track(given, camera).users,
    )


def test_users_not_chosen_have_a_position_only(images, models):
    tracker = ossa.Tracker(models=models)
    tracker.choose_users([77])
    body = tracker.track(*images[0]).bodies[0]
    assert not body.tracked and np.isnan(body.joints).all() and np.isfinite(body.position).all()
    assert set(body.states) == {"not_tracked"}
    tracker.choose_users()
    assert tracker.track(*images[1]).bodies[0].tracked


def test_seated_mode_changes_while_running(images, models):
    tracker = ossa.Tracker(models=models)
    standing = tracker.track(*images[0]).bodies[0]
    tracker.mode = "seated"
    seated = tracker.track(*images[1]).bodies[0]
    knee = ossa.Joint.KneeRight
    assert standing.states[knee] == "tracked" and seated.states[knee] == "not_tracked"
    assert tracker.mode == "seated"


def test_smoothing_changes_while_running(images, models):
    rough, smooth = ossa.Tracker(models=models), ossa.Tracker(models=models)
    smooth.smoothing = ossa.Holt(smoothing=0.9, prediction=0.0, max_deviation_radius_m=1.0)
    differences = [
        np.abs(a - b).max()
        for a, b in zip(skeletons_of(rough, images), skeletons_of(smooth, images))
    ]
    assert max(differences) > 1e-3
    smooth.smoothing = None
    assert smooth.smoothing is None


@pytest.mark.parametrize("smoothing", [*ossa.SMOOTHINGS, ossa.Holt(), ossa.OneEuro()])
def test_every_smoothing_is_accepted(smoothing, images, models):
    assert ossa.Tracker(models=models, smoothing=smoothing).track(*images[0]).bodies


@pytest.mark.parametrize("method", ["none", "one-euro", "kalman", "shum-ho-2012", "plantard-2016"])
def test_every_method_is_accepted_by_name(method, images):
    assert ossa.Tracker(method).track(*images[0]).bodies[0].tracked


def test_method_options_reach_the_method(images):
    few = skeletons_of(ossa.Tracker("shum-2013", neighbours=3, steps=2), images[:6])
    many = skeletons_of(ossa.Tracker("shum-2013"), images[:6])
    assert np.abs(np.array(few) - many).max() > 1e-4


def test_option_that_the_method_does_not_read_is_refused():
    with pytest.raises(ossa.InputError, match="neighbours.*shum-2013.*found 'holt'"):
        ossa.Tracker("holt", neighbours=3)


def test_physics_moves_joints(images, models):
    plain = skeletons_of(ossa.Tracker(models=models), images[:10])
    physical = skeletons_of(ossa.Tracker(models=models, physics=True), images[:10])
    assert np.abs(np.array(plain) - physical).max() > 1e-4


def test_given_bone_lengths_are_kept(images, models, frames):
    known = {1: frames[-1].bodies[0].bones_m}
    tracker = ossa.Tracker(models=models, bones_m=known)
    made = [tracker.track(*image).bodies[0].bones_m for image in images[:3]]
    assert np.allclose(made, known[1])


def test_rotated_camera_gives_results_in_its_own_space(images, models):
    upright = ossa.Tracker(models=models, parts=True)
    lying = ossa.Tracker(models=models, parts=True, probabilities=True, proposals=True)
    for depth_mm, camera, time_s in images[:3]:
        a = upright.track(depth_mm, camera, time_s)
        turned = np.ascontiguousarray(np.rot90(depth_mm))  # by 90 degrees counter-clockwise
        on_side = ossa.Camera(camera.fy, camera.fx, camera.cy, 319 - camera.cx, rotate=90)
        b = lying.track(turned, on_side, time_s)
    assert lying.rotation == 90
    assert (np.rot90(a.users) == b.users).mean() > 0.99
    assert (b.probabilities.argmax(-1)[b.users == 0] == 0).all()
    assert b.probabilities.shape == turned.shape + (33,)
    x, y, z = a.bodies[0]["Head"]
    assert np.allclose(b.bodies[0]["Head"], (-y, x, z), atol=0.05) or np.allclose(
        b.bodies[0]["Head"], (y, -x, z), atol=0.05
    )
    head = b.bodies[0].proposals[ossa.Joint.Head].positions[0]
    assert np.allclose(head, b.bodies[0].raw[ossa.Joint.Head], atol=1e-9)


@pytest.mark.parametrize("lag", [0, 1, 2])
def test_lag_returns_every_frame_once_with_its_time(lag, clip):
    now = list(ossa.Tracker(smoothing="none").run(clip))
    late = list(ossa.Tracker(smoothing="none", lag=lag).run(clip))
    assert [f.time_s for f in late] == [f.time_s for f in now]
    assert [f.index for f in late] == [f.index for f in now]
    differs = [not np.array_equal(a.bodies[0].joints, b.bodies[0].joints) for a, b in zip(now, late)]
    assert any(differs) == (lag > 0)


def test_lagged_track_returns_none_until_the_first_frame_is_due(images, models):
    tracker = ossa.Tracker(models=models, lag=2)
    frames = [tracker.track_late(*image) for image in images[:3]]
    assert [frame is None for frame in frames] == [True, True, False]
    held = [tracker.take_held() for _ in range(3)]
    assert [frame.index for frame in frames[2:] + held[:2]] == [0, 1, 2]
    assert held[2] is None


def test_default_time_advances_by_a_thirtieth_of_a_second(images, models):
    tracker = ossa.Tracker(models=models)
    times = [tracker.track(image.depth_mm, image.camera).time_s for image in images[:3]]
    assert np.allclose(times, [0, 1 / 30, 2 / 30])


def test_reset_deletes_all_people(images, models):
    tracker = ossa.Tracker(models=models)
    first = tracker.track(*images[0])
    tracker.reset()
    again = tracker.track(*images[0])
    assert np.array_equal(first.bodies[0].joints, again.bodies[0].joints)


def test_models_of_another_method_are_refused(models):
    with pytest.raises(ossa.InputError, match="models: expected those of method 'holt'"):
        ossa.Tracker("holt", models=models)


def test_person_file_is_read_and_named_when_damaged(clip, images, models, command, tmp_path):
    me = tmp_path / "me.ossaperson"
    command("track", clip, "--save-person", me, "--quiet")
    known = ossa.Tracker(models=models, person=me).track(*images[0]).bodies[0].fit.shape
    alone = ossa.Tracker(models=models).track(*images[0]).bodies[0].fit.shape
    told = list(ossa.Tracker(models=models).run(clip))[-1].bodies[0].fit.shape
    assert np.abs(known - told).sum() < np.abs(alone - told).sum()
    me.write_bytes(b"no person")
    with pytest.raises(ossa.InputError, match="me.ossaperson"):
        ossa.Tracker(models=models, person=[me])


def test_scene_objects_are_returned_and_mount_can_be_level(clip, models, tmp_path):
    scene = tmp_path / "room.toml"
    scene.write_text(SCENE)
    frames = list(ossa.Tracker(models=models, scene=scene, mount="level").run(clip))
    things = frames[-1].objects
    assert [thing.name for thing in things] == ["crate"]
    assert things[0].position.shape == (3,) and things[0].orientation.shape == (4,)
    assert things[0].held_by == ()
    assert not list(ossa.Tracker(models=models).run(clip))[-1].objects


# A first start makes tables beside the tracker from the eighth image on: the ninth comes meanwhile.
FORKS = """
import os, sys
from pathlib import Path
import ossa
tracker, images = ossa.Tracker(), list(ossa.open(sys.argv[1]))
for image in images[:9]:
    tracker.track(*image)
child = os.fork()
joints = [tracker.track(*image).bodies[0].joints.tolist() for image in images[9:12]]
Path(sys.argv[2], "parent" if child else "child").write_text(str(joints))
if child:
    sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


def test_forked_process_tracks_while_tables_are_built(clip, tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", FORKS, str(clip), str(tmp_path)],
        env={**os.environ, "OSSA_CACHE": str(tmp_path)},
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    parent, child = (tmp_path / who for who in ("parent", "child"))
    assert parent.read_text() == child.read_text()
