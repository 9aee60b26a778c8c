"""ossa.write_images, and images that another program writes."""

import io
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import ossa


def test_images_are_read_as_they_were_written(images, tmp_path):
    os.mkfifo(tmp_path / "pipe")

    def write():
        with open(tmp_path / "pipe", "wb") as pipe:
            assert ossa.write_images(images, pipe) == len(images)

    writer = threading.Thread(target=write)
    writer.start()
    with ossa.open(tmp_path / "pipe") as source:
        assert source.is_live and source.frame_count is None
        read = list(source)
    writer.join()
    assert len(read) == len(images)
    for one, image in zip(read, images):
        assert np.array_equal(one.depth_mm, image.depth_mm)
        assert one.time_s == pytest.approx(image.time_s - images[0].time_s, abs=1e-6)
        assert one.camera.fx == image.camera.fx and one.camera.cy == image.camera.cy


def test_a_camera_for_another_size_is_scaled(images):
    out = io.BytesIO()
    half = images[0].depth_mm[::2, ::2]  # not contiguous
    ossa.write_images([(half, images[0].camera, 0.0)], out)
    fx = images[0].camera.fx / 2
    assert f"# camera {fx!r},".encode() in out.getvalue()
    assert out.getvalue().endswith(half.astype(">u2").tobytes())


@pytest.mark.parametrize("image, named", [
    ((np.zeros((4, 4)), ossa.Camera(5, 5, 2, 2), 0.0), "depth_mm: expected uint16"),
    ((np.zeros((4, 4), np.uint16), None, 0.0), "camera: expected an ossa.Camera"),
    ((np.zeros((4, 4), np.uint16), ossa.Camera(5, 5, 2, 2), "soon"), "time_s: expected a number"),
    ((np.zeros((4, 4), np.uint16), ossa.Camera(5, 5, 2, 2)), "images: expected"),
])  # fmt: skip
def test_what_is_no_image_is_refused(image, named):
    with pytest.raises(ossa.InputError, match=named):
        ossa.write_images([image], io.BytesIO())


def test_a_writer_ends_with_its_reader(clip):
    program = f"import ossa; print(ossa.write_images(ossa.open({str(clip)!r})), file=__import__('sys').stderr)"
    writer = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    writer.stdout.read(1000)
    writer.stdout.close()
    assert int(writer.stderr.read()) < 24 and writer.wait(60) == 0
