"""ossa.write_images: depth images for `ossa track -` and other programs that read a pipe."""

from __future__ import annotations

import os
import sys
from typing import Any, BinaryIO, Iterable, Optional

import numpy as np
import numpy.typing as npt

from . import _check
from ._camera import Camera

Image = Any  # (depth_mm, camera, time_s)

_TIMES_S = (-1e11, 1e11)  # those that a reader of the images accepts


def write_images(images: Iterable[Image], to: Optional[BinaryIO] = None) -> int:
    """Writes depth images for `ossa track -`, `ossa view -` and `ossa record -`, as they come:

        camera.py | ossa view -

    Each is a binary PGM image of 16 bits, whose header has comments with its camera and time.

    Parameters
    ----------
    images : iterable of (depth_mm, camera, time_s)
        As ossa.open yields them and Tracker.track takes them: uint16 [H, W] in millimetres, an
        ossa.Camera, and seconds by any clock that increases.
    to : binary file, optional
        Left out: standard output. Each image is flushed.

    Returns
    -------
    int
        The number of images written: all, or those until the reader has ended.

    Raises
    ------
    ossa.InputError
        For an invalid image.
    """
    out = sys.stdout.buffer if to is None else to
    written = 0
    try:
        for image in images:
            if not isinstance(image, tuple) or len(image) != 3:
                raise _check.refuse("images", "(depth_mm, camera, time_s) of each", image)
            depth_mm, camera, time_s = image
            _write(out, _check_depth(depth_mm), camera, _check.number("time_s", time_s, *_TIMES_S))
            written += 1
    except BrokenPipeError:
        if to is None:  # or Python would complain at its end that it cannot flush
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return written


def _check_depth(depth_mm: Any) -> npt.NDArray[np.uint16]:
    image: npt.NDArray[np.uint16] = _check.image(depth_mm)
    if image.dtype != np.uint16 or image.ndim != 2 or image.size == 0:
        raise _check.refuse("depth_mm", "uint16 [height, width]", depth_mm)
    return image


def _write(out: BinaryIO, image: npt.NDArray[np.uint16], camera: Camera, time_s: float) -> None:
    height, width = image.shape
    if not isinstance(camera, Camera):
        raise _check.refuse("camera", "an ossa.Camera", camera)
    lens = camera if camera.width is None else camera.for_size(width, height)
    numbers = ",".join(repr(float(number)) for number in (lens.fx, lens.fy, lens.cx, lens.cy))
    header = f"P5\n# time_s {time_s:.6f}\n# camera {numbers}\n{width} {height}\n65535\n"
    out.write(header.encode() + image.astype(">u2").tobytes())
    out.flush()
