"""Every invalid argument is an ossa.InputError of one line, never a crash."""

import inspect
import random

import numpy as np
import pytest

import ossa

CAMERA = ossa.Camera.preset("kinect-v1")
DEPTH = np.zeros((48, 64), np.uint16)


@pytest.fixture(scope="module")
def tracker(models):
    return ossa.Tracker(models=models)


@pytest.fixture(scope="module")
def forest():
    return ossa.Forest()


def refused(call, *arguments, **named):
    """The message; fails where the call succeeds or raises something else."""
    with pytest.raises(ossa.InputError) as caught:
        call(*arguments, **named)
    message = str(caught.value)
    assert message and "\n" not in message
    return message


NOT_IMAGES = [
    None, 3, "depth", [[1, 2], [3, 4]], DEPTH.astype(np.int16), DEPTH.astype(float),
    DEPTH.astype(">u2"), DEPTH[0], DEPTH[None], DEPTH.T, np.asfortranarray(DEPTH), DEPTH[::-1],
    DEPTH[:, ::2], DEPTH[:, ::-1], np.zeros((0, 0), np.uint16), np.zeros((5, 0), np.uint16),
    np.zeros((1, 9000), np.uint16), np.broadcast_to(np.uint16(7), (48, 64)), DEPTH.astype(object),
    np.array(5, np.uint16), np.ma.masked_array(DEPTH), DEPTH.view([("a", "u2")]),
    np.frombuffer(bytes(2 * 48 * 64 + 1), np.uint8)[1:].view(np.uint16).reshape(48, 64),
]  # fmt: skip


@pytest.mark.parametrize("depth_mm", NOT_IMAGES, ids=range(len(NOT_IMAGES)))
def test_track_refuses_invalid_depth_images(depth_mm, tracker, forest):
    assert "depth_mm" in refused(tracker.track, depth_mm, CAMERA, 0.0)
    assert "depth_mm" in refused(forest.classify, depth_mm, CAMERA)


def test_track_accepts_a_memory_mapped_array(tracker, tmp_path):
    mapped = np.memmap(tmp_path / "depth", np.uint16, "w+", shape=DEPTH.shape)
    assert tracker.track(mapped, CAMERA, 0.0).bodies == []


def test_message_says_how_to_convert_another_memory_order(tracker):
    assert "ascontiguousarray" in refused(tracker.track, np.asfortranarray(DEPTH), CAMERA)


@pytest.mark.parametrize("camera", [None, "kinect-v1", (575, 575, 320, 240), 5, ossa.Camera])
def test_track_refuses_invalid_cameras(camera, tracker):
    assert "camera" in refused(tracker.track, DEPTH, camera, 0.0)


@pytest.mark.parametrize("value", [0, -1, np.nan, np.inf, 1e9, None, "575", True, [575]])
def test_camera_refuses_invalid_focal_lengths(value):
    assert "fx" in refused(ossa.Camera, value, 575, 320, 240)


@pytest.mark.parametrize(
    "named",
    [
        {"width": 640}, {"width": 0, "height": 480}, {"width": 640.5, "height": 480},
        {"width": 9999, "height": 480}, {"rotate": 45}, {"rotate": "left"}, {"rotate": True},
    ],  # fmt: skip
)
def test_camera_refuses_invalid_sizes_and_rotations(named):
    refused(ossa.Camera, 575, 575, 320, 240, **named)


@pytest.mark.parametrize("time_s", [np.nan, np.inf, "0", [0.0], 1e300, True])
def test_track_refuses_invalid_times(time_s, tracker):
    assert "time_s" in refused(tracker.track, DEPTH, CAMERA, time_s)


@pytest.mark.parametrize(
    "named",
    [
        {"method": "worst"}, {"method": None}, {"physics": 1}, {"model": "nowhere.ossa"},
        {"model": 5}, {"model": ""}, {"model": "a\0b"}, {"model": "\udcff"}, {"smoothing": "much"},
        {"smoothing": 0.5}, {"smoothing": ossa.Holt(smoothing=2.0)},
        {"smoothing": ossa.OneEuro(min_cutoff_hz=0)}, {"smoothing": ossa.Holt(smoothing=np.nan)},
        {"max_users": 0}, {"max_users": 7}, {"max_users": 1.0}, {"threads": 0}, {"threads": 10**30},
        {"seated": "yes"}, {"near": 0}, {"parts": None}, {"seed": -1}, {"seed": 2**70},
        {"control": "motor"}, {"hinges": True}, {"control": "magic", "physics": True},
        {"neighbours": 3}, {"method": "shum-2013", "neighbours": 1},
        {"method": "shum-2013", "solver": "luck"}, {"method": "shum-2013", "style": -1.0},
        {"method": "liu-2016"}, {"method": "holt", "learned": "x.ossagp"},
        {"method": "holt", "database": "x.ossadb"}, {"database": "a", "prior": "b"},
        {"bones_m": 5}, {"bones_m": {1: [1, 2]}}, {"bones_m": {"a": np.ones(20)}},
        {"bones_m": {1: np.full(20, np.nan)}}, {"bones_m": {1: np.full(20, -1.0)}},
        {"person": 5}, {"person": "nowhere.ossaperson"}, {"person": "me.ossaperson", "fit": False},
        {"person": ["a", "b"], "max_users": 1}, {"mount": "wall"}, {"mount": None},
        {"scene": 5}, {"scene": "nowhere.toml"}, {"models": "shipped"}, {"repair": "yes"},
    ],  # fmt: skip
    ids=str,
)
def test_tracker_refuses_invalid_options(named):
    refused(ossa.Tracker, **named)


@pytest.mark.parametrize("ids", ["1", 1.5, [1.5], [None], [-1], [2**40], {1: 2}, object()])
def test_choose_users_refuses_invalid_ids(ids, tracker):
    assert "ids" in refused(tracker.choose_users, ids)


def test_choose_users_accepts_a_zero_dimensional_array(tracker):
    tracker.choose_users(np.array(1))
    tracker.choose_users()


def test_tracker_refuses_invalid_settings_while_it_runs(tracker):
    for name, value in {"mode": "lying", "smoothing": 7}.items():
        refused(setattr, tracker, name, value)


@pytest.mark.parametrize(
    "named",
    [
        {"source": "nowhere"}, {"source": None}, {"source": ""}, {"source": "/dev/null"},
        {"source": "nowhere\n\x1b[31m.oni"}, {"source": "openni:nowhere"},
        {"camera": "no such camera"}, {"camera": 5}, {"camera": "1,2,3"}, {"camera": "0,0,0,0"},
        {"depth_scale": 0}, {"depth_scale": "1000"}, {"fps": np.nan}, {"rotate": 30},
        {"depth_format": "odd"}, {"mirrored": 1}, {"wait_s": -1}, {"patience_s": 0},
        {"keep_waiting": True},
    ],  # fmt: skip
    ids=str,
)
def test_open_refuses_invalid_options(named, clip):
    refused(lambda **n: next(ossa.open(**n)), **{"source": clip, **named})


@pytest.mark.parametrize(
    "named",
    [
        {"times": [0, 1]}, {"times": [np.nan]}, {"times": "now"}, {"joints": np.zeros((1, 19, 3))},
        {"joints": np.full((1, 20, 3), np.inf)}, {"joints": None}, {"states": [["seen"] * 20]},
        {"states": [["tracked"]]}, {"ids": [-2]}, {"ids": [2**40]}, {"ids": ["a"]},
        {"confidence": np.zeros(20)}, {"floor": [0, 1, 0, 0]}, {"sensor": 5}, {"ids": [1.5]},
        {"frames": [0.5]}, {"ids": [np.nan]}, {"times": np.ma.masked_equal([0.0], 0.0)},
        {"joints": np.ones((1, 20, 3)) * 1j},
    ],  # fmt: skip
    ids=str,
)
def test_sequence_refuses_invalid_arrays(named):
    refused(ossa.Sequence, **{"times": [0.0], "joints": np.zeros((1, 20, 3)), **named})


def test_write_refuses_a_sequence_that_was_damaged_after_construction(tmp_path):
    sequence = ossa.Sequence([0.0, 1.0], np.zeros((2, 20, 3)))
    sequence.joints = np.zeros((1, 20, 3))
    refused(ossa.reconstruct, sequence)
    refused(ossa.write_skeletons, sequence, tmp_path / "a.jsonl")


def test_write_refuses_values_that_no_file_can_store(tmp_path):
    """Without this a file was written that ossa itself refuses to read."""
    rows = {"times": [0.0, 1.0], "joints": np.zeros((2, 20, 3))}
    part = np.zeros((2, 20, 4))
    part[..., 1:] = np.nan
    for name, value in {
        "times": [1.0, 0.0], "confidence": np.full((2, 20), 7.0), "joints": np.full((2, 20, 3), 1e9),
        "reliability": np.full((2, 20), -0.1), "floor": [[0, 1, np.nan, 0]] * 2,
        "bones_m": np.full((2, 20), 5.0),
    }.items():  # fmt: skip
        sequence = ossa.Sequence(**{**rows, name: value})
        assert name in refused(ossa.write_skeletons, sequence, tmp_path / "a.jsonl")
        assert name in refused(ossa.reconstruct, sequence)
    for turns in (np.zeros((2, 20, 4)), part):
        sequence = ossa.Sequence(**rows, orientations=turns)
        assert "orientations" in refused(ossa.write_skeletons, sequence, tmp_path / "a.jsonl")
    twice = ossa.Sequence([0.0, 0.0], rows["joints"], ids=[3, 3])
    assert "3 twice" in refused(ossa.write_skeletons, twice, tmp_path / "a.jsonl")
    assert not (tmp_path / "a.jsonl").exists()


@pytest.mark.parametrize(
    "call, arguments, named",
    [
        (ossa.reconstruct, [5], {}), (ossa.read_skeletons, ["nowhere"], {}),
        (ossa.read_skeletons, [None], {}), (ossa.read_skeletons, [__file__], {}),
        (ossa.read_skeletons, [__file__], {"format": "odd"}),
        (ossa.read_recordings, [__file__], {"columns": "third"}),
        (ossa.write_skeletons, [None, "a.jsonl"], {}), (ossa.compare, ["nowhere", "nowhere"], {}),
        (ossa.compare, ["a", []], {}), (ossa.compare, ["a", "b"], {"align": "loosely"}),
        (ossa.compare, ["a", "b"], {"time": None}), (ossa.compare, ["a", "b"], {"only": 5}),
        (ossa.evaluate, ["nowhere", "nowhere"], {}), (ossa.evaluate, ["a", "b"], {"every": 0}),
        (ossa.learn, ["a", "b", "c.txt"], {}), (ossa.learn, ["a", "b", "c.ossagp"], {}),
        (ossa.learn, ["a", ["b", "b"], "c.ossagp"], {}),
        (ossa.learn, ["a", "b", "c.ossagp"], {"pairs": 1}), (ossa.Forest, ["nowhere"], {}),
        (ossa.Camera.preset, ["kinect-v9"], {}), (ossa.Camera.preset, ["d435"], {"width": 5}),
        (CAMERA.points, [np.zeros(5)], {}), (CAMERA.project, [[1, 2]], {}),
        (CAMERA.points, [DEPTH + 1.5], {}), (CAMERA.points, [DEPTH.astype(int) + 70000], {}),
        (CAMERA.project, ["here"], {}),
    ],
)  # fmt: skip
def test_other_calls_refuse_invalid_arguments(call, arguments, named):
    refused(call, *arguments, **named)


def odd_values(random_):
    """One value of a random type that a caller might pass."""
    shapes = [(), (0,), (3,), (20,), (2, 2), (20, 3), (1, 20, 3), (48, 64), (3, 48, 64)]
    dtypes = ["u1", "u2", "i2", ">u2", "f4", "f8", "?", "O", "U3", "M8[s]", "c16"]
    return random_.choice(
        [
            None, True, -1, 0, 1, 2**31, 2**63, 2**200, -1e-300, float("nan"), float("inf"), 1j,
            "", "auto", "best", "\ud800", "\0", b"x", [], {}, (), set(), object(), int, print,
            [[[]]], {"a": 1}, range(5), slice(3), np.float32(1), np.int64(-5), np.datetime64("now"),
            np.zeros(random_.choice(shapes), random_.choice(dtypes)),
            ossa.Joint.Head, CAMERA, ossa.Holt(),
        ]
    )  # fmt: skip


def test_random_arguments_never_crash(tracker, forest, clip, tmp_path):
    calls = [
        tracker.track, tracker.choose_users, forest.classify, forest.propose, ossa.Camera,
        ossa.Camera.preset, CAMERA.for_size, CAMERA.points, CAMERA.project, ossa.Sequence,
        ossa.reconstruct, ossa.compare, ossa.evaluate, ossa.open, ossa.read_skeletons,
        ossa.read_recordings,
    ]  # fmt: skip
    good = {
        "depth_mm": DEPTH, "camera": CAMERA, "time_s": 0.0, "times": [0.0], "fx": 5, "fy": 5,
        "cx": 5, "cy": 5, "joints": np.zeros((1, 20, 3)), "width": 64, "height": 48,
        "points_m": np.ones(3), "source": clip, "path": clip / "truth.jsonl",
        "truth": clip / "truth.jsonl", "result": clip / "truth.jsonl", "model": "none",
        "dataset": clip, "name": "d435", "ids": [1], "sequence": None,
    }  # fmt: skip
    for seed in range(1500):
        random_ = random.Random(seed)
        call = random_.choice(calls)
        named = {}
        for parameter in inspect.signature(call).parameters.values():
            if parameter.name.startswith("_"):
                continue
            if random_.random() < 0.3:
                named[parameter.name] = odd_values(random_)
            elif parameter.default is parameter.empty:
                named[parameter.name] = good[parameter.name]
        try:
            call(**named)
        except ossa.InputError as error:
            assert "\n" not in str(error) and len(str(error)) < 1000, seed
        except Exception as error:
            raise AssertionError(f"seed {seed}: {call.__qualname__}({named})") from error
