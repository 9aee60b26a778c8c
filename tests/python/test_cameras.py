"""The camera examples with the wheels of their makers, over a software device or a recording."""

import importlib
import itertools
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import ossa
from record_realsense import record_realsense

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "tools/python/cameras"
EXAMPLES = sorted(FOLDER.glob("*.py"))


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    """pyorbbecsdk writes a log into the working folder as soon as it is imported."""
    monkeypatch.chdir(tmp_path)


def example(name, *wheels):
    """The example as a module, where its maker's wheel can be had."""
    for wheel in wheels:
        pytest.importorskip(wheel)
    sys.path.insert(0, str(FOLDER))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(FOLDER))


def run(name, *arguments):
    """What the example prints as a program."""
    return subprocess.run(
        [sys.executable, FOLDER / f"{name}.py", *map(str, arguments)],
        check=True, capture_output=True, text=True, timeout=120,
    ).stdout  # fmt: skip


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_short_and_compile(path):
    text = path.read_text()
    assert text.count("\n") < 50
    compile(text, str(path), "exec")


def test_realsense_example_reads_a_recording_of_a_software_device(images, tmp_path):
    realsense = example("realsense", "pyrealsense2")
    rs = realsense.rs
    played = record_realsense(rs, images, tmp_path / "made.db3")
    first = np.asanyarray(played[0].as_depth_frame().get_data())
    assert np.array_equal(first, images[0].depth_mm)

    config, pipeline = rs.config(), rs.pipeline()
    config.enable_device_from_file(str(tmp_path / "made.db3"), repeat_playback=False)
    config.enable_stream(rs.stream.depth)
    pipeline.start(config)
    read = list(realsense.images(pipeline))
    assert len(read) >= 20  # a player may drop some
    assert any(np.array_equal(read[0][0], image.depth_mm) for image in images[:4])
    assert read[0][1].fx == pytest.approx(images[0].camera.fx)
    assert len(ossa.Tracker().track(*read[0]).bodies) == 1


def test_realsense_example_runs_as_a_program(images, tmp_path):
    realsense = example("realsense", "pyrealsense2")
    record_realsense(realsense.rs, images, tmp_path / "made.db3")
    assert run("realsense", tmp_path / "made.db3").count("\n") >= 12


def test_realsense_example_pipes_its_images(images, tmp_path):
    realsense = example("realsense", "pyrealsense2")
    record_realsense(realsense.rs, images, tmp_path / "made.db3")
    piped = subprocess.run(
        [sys.executable, FOLDER / "realsense.py", tmp_path / "made.db3", "--pipe"],
        check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    (tmp_path / "made.pgm").write_bytes(piped.stdout)
    read = list(ossa.open(tmp_path / "made.pgm"))
    assert len(read) >= 20  # a player may drop some
    assert any(np.array_equal(read[0].depth_mm, image.depth_mm) for image in images[:4])
    assert read[0].camera.fx == pytest.approx(images[0].camera.fx)
    assert read[1].time_s == pytest.approx(1 / 30, abs=0.05)


def assert_opens(recording, images):
    """All depth images and the camera are read as they were recorded."""
    try:
        read = list(ossa.open(recording))
    except ossa.InputError as error:
        if "built without" in str(error):
            pytest.skip(str(error))
        raise
    assert len(read) == len(images)
    for frame, image in zip(read, images):
        assert np.array_equal(frame.depth_mm, image.depth_mm)
    assert read[0].camera.fx == pytest.approx(images[0].camera.fx)


@pytest.mark.parametrize("compressed", [True, False], ids=["compressed", "plain"])
def test_open_reads_a_db3_of_a_realsense(images, tmp_path, compressed):
    realsense = example("realsense", "pyrealsense2")
    record_realsense(realsense.rs, images, tmp_path / "made.db3", compressed)
    assert_opens(tmp_path / "made.db3", images)


def test_open_reads_a_bag_of_a_realsense(images, tmp_path):
    """A program of its own: two versions of pyrealsense2 do not fit into one."""
    older = pathlib.Path(sys.prefix) / "realsense_bag"
    if not older.is_dir():
        pytest.skip("the pyrealsense2 that records .bag files is not here")
    np.savez(tmp_path / "images.npz", depth_mm=np.stack([image.depth_mm for image in images]),
             times_s=[image.time_s for image in images], camera=_numbers(images[0].camera))  # fmt: skip
    subprocess.run(
        [sys.executable, pathlib.Path(__file__).with_name("record_realsense.py"),
         tmp_path / "images.npz", tmp_path / "made.bag"],
        check=True, env={**os.environ, "PYTHONPATH": str(older)}, timeout=120,
    )  # fmt: skip
    assert_opens(tmp_path / "made.bag", images)


def _numbers(camera):
    return [camera.fx, camera.fy, camera.cx, camera.cy]


def test_azure_kinect_example_reads_a_recording(shared):
    recording = shared / "real/recordings/azure_kinect.mkv"
    if not recording.is_file():
        pytest.skip(f"{recording} is not there")
    run("azure_kinect", recording)  # nobody is in it


def test_azure_kinect_example_imports_pyk4a():
    pytest.importorskip("pyk4a")
    assert example("azure_kinect").images


def test_orbbec_example_reads_a_frame_of_the_sdk(images):
    orbbec = example("orbbec", "pyorbbecsdk")
    ob = orbbec.ob
    image = images[0]
    height, width = image.depth_mm.shape
    frame = ob.Frame.create_video_frame(
        ob.OBFrameType.DEPTH_FRAME, ob.OBFormat.Y16, width, height, 0
    ).as_depth_frame()
    frame.update_data(image.depth_mm.reshape(-1).view(np.uint8))
    lens = ob.OBCameraIntrinsic()
    lens.fx, lens.fy, lens.cx, lens.cy = 287.5, 287.5, 160.0, 120.0
    lens.width, lens.height = width, height
    frame.get_stream_profile().as_video_stream_profile().set_intrinsic(lens)
    depth_mm, camera, _ = orbbec.image_of(frame)
    assert np.array_equal(depth_mm, image.depth_mm) and camera.fx == pytest.approx(287.5)


def test_kinect_v1_example_imports_freenect():
    assert example("kinect_v1", "freenect").images


def test_openni2_example_reads_a_recording(shared):
    recording = shared / "real/recordings/kinect_v1_openni1.oni"
    if not recording.is_file():
        pytest.skip(f"{recording} is not there")
    openni = example("openni2", "openni")
    openni.openni2.initialize(openni.LIBRARIES)
    device = openni.openni2.Device(str(recording).encode())
    depth_mm, camera, _ = next(openni.images(device, 1))
    assert depth_mm.shape == (480, 640) and camera.fx == pytest.approx(575.8, abs=1)
    first = itertools.islice(ossa.open(recording), 10)  # a player starts with one of these
    assert any(np.array_equal(depth_mm, image.depth_mm) for image in first)
