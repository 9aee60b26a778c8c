"""ossa.open and ossa.Camera."""

import threading

import numpy as np
import pytest

import ossa


def test_data_set_yields_images_cameras_and_times(clip):
    with ossa.open(clip) as source:
        assert source.frame_count == 24 and not source.is_live
        images = list(source)
    assert len(images) == 24
    depth_mm, camera, time_s = images[1]
    assert depth_mm.dtype == np.uint16 and depth_mm.shape == (240, 320)
    assert depth_mm.flags.c_contiguous and depth_mm.flags.writeable
    assert (camera.width, camera.height) == (320, 240) and camera.rotate == "auto"
    assert time_s == pytest.approx(1 / 30, abs=1e-3)


def test_images_outlive_their_source(clip):
    source = ossa.open(clip)
    depth_mm = next(source).depth_mm
    kept = depth_mm.copy()
    source.close()
    del source
    assert (depth_mm == kept).all()


def test_closed_source_raises(clip):
    source = ossa.open(clip)
    source.close()
    with pytest.raises(ossa.InputError, match="closed"):
        next(source)


def test_close_in_another_thread_ends_the_wait_for_an_image(clip):
    silent = f"openni:ossa://{clip}?stall_after=1"
    with ossa.open(silent, patience_s=600) as source:
        next(source)
        another = threading.Timer(0.2, source.close)
        another.start()
        with pytest.raises(ossa.InputError, match="stall_after=1: .*closed"):
            next(source)
        another.join()


def test_assumptions_are_in_the_notes(clip, tmp_path):
    (tmp_path / "000000.png").write_bytes((clip / "depth/000000.png").read_bytes())
    source = ossa.open(tmp_path)
    next(source)
    assert any("kinect-v1" in note for note in source.notes)


@pytest.mark.parametrize("camera", ["xtion", "575,575,160,120", ossa.Camera(575, 575, 160, 120)])
def test_given_camera_overrides_that_of_the_source(camera, clip):
    assert ossa.open(clip, camera=camera).camera.fx != ossa.open(clip).camera.fx


def test_camera_may_be_a_file(clip, tmp_path):
    file = tmp_path / "cameras.txt"
    file.write_text("1 PINHOLE 320 240 300 310 160.5 120.5\n")
    camera = ossa.open(clip / "depth", camera=file).camera
    assert (camera.fx / camera.width, camera.fy / camera.height) == pytest.approx((300 / 320, 310 / 240))


@pytest.mark.parametrize(
    "option", [{"camera": "x"}, {"depth_format": "x"}, {"depth_scale": 1, "depth_format": "disparity"}]
)
def test_refusals_name_the_argument_as_python_does(option, clip):
    with pytest.raises(ossa.InputError) as caught:
        ossa.open(clip / "depth", **option)
    assert list(option)[0] in str(caught.value) and "--" not in str(caught.value)


def test_rotation_of_a_source_is_kept_in_its_camera(clip):
    on_its_side = ossa.Camera(290, 290, 160, 120, rotate=90)
    assert next(ossa.open(clip, camera=on_its_side)).camera.rotate == 90
    assert next(ossa.open(clip, camera=on_its_side, rotate=180)).camera.rotate == 180
    assert next(ossa.open(clip, camera="kinect-v1")).camera.rotate == "auto"


def test_depth_scale_and_fps_are_applied(clip):
    plain = next(ossa.open(clip / "depth", camera="kinect-v1")).depth_mm
    scaled = next(ossa.open(clip / "depth", camera="kinect-v1", depth_scale=2000)).depth_mm
    assert np.abs(scaled.astype(int) - plain // 2).max() <= 1
    images = list(ossa.open(clip / "depth", fps=10))
    assert images[1].time_s - images[0].time_s == pytest.approx(0.1)


def test_mirrored_images_are_unmirrored(clip):
    told = {"camera": "300,300,150,120"}
    mirrored = next(ossa.open(clip / "depth", **told))
    seen = next(ossa.open(clip / "depth", **told, mirrored=True))
    assert (seen.depth_mm == mirrored.depth_mm[:, ::-1]).all()
    assert seen.depth_mm.flags.c_contiguous
    assert seen.camera.cx == 320 - 1 - 150


def test_missing_source_is_reported_in_one_line():
    with pytest.raises(ossa.InputError, match="nowhere.oni") as caught:
        ossa.open("nowhere.oni")
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("name", ossa.CAMERA_PRESETS)
def test_presets_are_cameras(name):
    camera = ossa.Camera.preset(name)
    assert camera.fx > 100 and camera.width > 0
    assert ossa.Camera.preset(name, 320, 240).width == 320


def test_preset_adapts_to_other_modes_of_the_sensor():
    # A RealSense crops: its focal length in 640x480 is not that of 848x480 scaled by width.
    assert ossa.Camera.preset("d435").for_size(640, 480) == ossa.Camera.preset("d435", 640, 480)


def test_points_are_the_inverse_of_project():
    camera = ossa.Camera(570, 575, 158, 119, 320, 240)
    depth_mm = np.full((240, 320), 2000, np.uint16)
    depth_mm[0, 0] = 0
    points = camera.points(depth_mm)
    assert np.isnan(points[0, 0]).all()
    assert np.allclose(camera.project(points[200, 100]), (100, 200))
    assert points[200, 100, 0] > 0 and points[200, 100, 1] < 0  # left of the sensor, below


def test_recordings_of_other_programs_are_read(shared):
    recording = shared / "real/recordings/azure_kinect.mkv"
    if not recording.is_file():
        pytest.skip(f"{recording} is not there")
    image = next(ossa.open(recording))
    assert image.depth_mm.any() and image.camera.fx > 200


def test_camera_found_by_the_search_applies_to_later_images(clip):
    source = ossa.open(clip)
    source._take_camera((300.0, 301.0, 160.0, 120.0, 320, 240), "found")
    assert source.camera.fx == 300.0 and source.notes == [f"{clip}: found"]
    assert next(source).camera.fy == 301.0


def test_camera_search_identifies_the_camera_by_the_people(shared, models):
    images = shared / "real/itop_depth/side"
    if not images.is_dir():
        pytest.skip(f"{images} is not there")
    source = ossa.open(images)
    frames = list(ossa.Tracker(models=models).run(source))
    assert source.camera.fx == pytest.approx(119.05, rel=0.02)  # as its README says
    assert "that camera is used" in source.notes[-1]
    assert sum(len(frame.bodies) == 1 for frame in frames) > 0.9 * len(frames)


def depths_of(source, **options):
    with ossa.open(source, **options) as opened:
        return [(depth_mm, time_s) for depth_mm, _, time_s in opened]


@pytest.fixture
def images():
    random = np.random.default_rng(1)
    return random.integers(500, 5000, (4, 48, 64), dtype=np.uint16)


def expect_images(source, images):
    read = depths_of(source)
    assert len(read) == len(images)
    assert all((depth_mm == image).all() for (depth_mm, _), image in zip(read, images))


def test_numpys_files_are_sources(images, tmp_path):
    np.save(tmp_path / "a.npy", images)
    np.save(tmp_path / "metres.npy", images / 1000)
    np.save(tmp_path / "fortran.npy", np.asfortranarray(images))
    np.savez(tmp_path / "a.npz", depth=images, color=np.zeros((4, 48, 64, 3), np.uint8))
    np.savez_compressed(tmp_path / "sequence.npz", *images)
    for name in ["a.npy", "metres.npy", "fortran.npy", "a.npz", "sequence.npz"]:
        expect_images(tmp_path / name, images)


def test_folder_of_numpys_files_is_a_source(images, tmp_path):
    for i, image in enumerate(images):
        np.save(tmp_path / f"depth_{i}.npy", image / 1000)
    expect_images(tmp_path, images)


def test_times_in_an_archive_are_those_of_the_images(images, tmp_path):
    np.savez(tmp_path / "a.npz", depth=images, timestamps=1e9 + np.arange(4) * 0.25)
    assert [time_s for _, time_s in depths_of(tmp_path / "a.npz")] == [0, 0.25, 0.5, 0.75]


def test_matlabs_files_are_sources(images, tmp_path):
    matlab = pytest.importorskip("scipy.io")
    columns = np.moveaxis(images, 0, 2)
    matlab.savemat(tmp_path / "a.mat", {"d_depth": columns})
    matlab.savemat(tmp_path / "packed.mat", {"d_depth": columns / 1000}, do_compression=True)
    for name in ["a.mat", "packed.mat"]:
        expect_images(tmp_path / name, images)


def test_hdf5_files_are_sources(images, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("camera/depth", data=images, compression="gzip", chunks=True)
        file["half"] = (images / 1000).astype(np.float16)
    expect_images(tmp_path / "a.h5", images)
    half = depths_of(f"{tmp_path}/a.h5#half")
    # Half floats of 4 to 5 m are 4 mm apart.
    assert all(abs(depth_mm.astype(int) - image).max() <= 2 for (depth_mm, _), image in zip(half, images))


def test_tiff_images_are_sources(images, tmp_path):
    pillow = pytest.importorskip("PIL.Image")
    for i, image in enumerate(images):
        pillow.fromarray(image).save(tmp_path / f"{i}.tif", compression="tiff_lzw")
    expect_images(tmp_path, images)
