"""ossa.open: depth images of devices and recordings."""

from __future__ import annotations

import logging
import os
import time
from types import TracebackType
from typing import Any, Callable, Iterator, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _native
from ._camera import ROTATIONS, Camera
from ._names import CAMERA_PRESETS

_LOG = logging.getLogger("ossa")
_WAIT_MS = 100  # between checks for Ctrl-C
_LONGEST_S = 1e6  # eleven days

PathLike = Any  # str or os.PathLike


class DepthImage(NamedTuple):
    """One image of a source."""

    depth_mm: npt.NDArray[np.uint16]
    """uint16 [H, W], millimetres along the optical axis, 0 = no reading."""
    camera: Camera
    """The camera of the image."""
    time_s: float
    """The sensor's or recording's clock, seconds."""


class Source(Iterator[DepthImage]):
    """An open SOURCE: iterate over it, or use it in a `with` block. Made by ossa.open.

    Assumptions of the source (such as a camera by the image size) and losses are in `notes`, and are
    logged by the logger "ossa".
    """

    def __init__(self, name: str, options: dict[str, Any], rotate: Any, patience_s: float) -> None:
        self._name = name
        self._options = options
        self._rotate = rotate
        self._patience_s = patience_s
        self._dropped = 0
        self._last_camera: tuple[Any, Optional[Camera]] = (None, None)
        self.notes: list[str] = []
        try:
            self._native = _native.Source(name, options)
        except _native.InputError as error:
            raise _check.of_python(error) from None
        self._take_notes()

    def __iter__(self) -> Source:
        return self

    def __next__(self) -> DepthImage:
        seen = self._wait_for(self._native.read)
        if seen is None:
            raise StopIteration
        _, depth_mm, camera, time_s, _ = seen
        return DepthImage(depth_mm, self._camera_of(camera), time_s)

    def _wait_for(self, read: Callable[[int], tuple[Any, ...]]) -> Optional[tuple[Any, ...]]:
        """The next result of `read` (status first, number of lost images last); None at the end."""
        last_frame_s = time.monotonic()
        while True:
            seen = read(_WAIT_MS)
            self._take_notes()
            self._dropped += seen[-1]
            if seen[0] == "end":
                return None
            if seen[0] == "frame":
                return seen
            silent_s = time.monotonic() - last_frame_s
            if silent_s > self._patience_s and self._native.is_live():
                raise _native.InputError(f"{self._name}: no image came for {silent_s:.1f} s")

    def __enter__(self) -> Source:
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"ossa.open({self._name!r})"

    @property
    def name(self) -> str:
        """The SOURCE as it was given."""
        return self._name

    @property
    def camera(self) -> Camera:
        """The camera of the next images."""
        return self._camera_of(self._native.camera())

    @property
    def is_live(self) -> bool:
        """True for devices, whose images are lost if they are not read in time."""
        return self._native.is_live()

    @property
    def frame_count(self) -> Optional[int]:
        """Number of images of a recording; None for devices and files without that number."""
        return self._native.frame_count()

    @property
    def dropped(self) -> int:
        """Images lost so far: by a device, or because they could not be read."""
        return self._dropped

    def close(self) -> None:
        """Closes the device or file, also from another thread. A read during or after it raises
        InputError."""
        self._native.close()

    def _camera_of(self, numbers: Any) -> Camera:
        if self._last_camera[0] != numbers or self._last_camera[1] is None:
            fx, fy, cx, cy, width, height = numbers
            self._last_camera = (numbers, Camera(fx, fy, cx, cy, width, height, self._rotate))
        made = self._last_camera[1]
        assert made is not None
        return made

    def _take_camera(self, camera: tuple[float, float, float, float, int, int], why: str) -> None:
        """Replaces the assumed camera."""
        self._options["camera"] = camera
        self._native.take_camera(camera)
        note = f"{self._name}: {why}"
        self.notes.append(note)
        _LOG.info("%s", note)

    def _take_notes(self) -> None:
        for kind, note in self._native.take_notes():
            self.notes.append(note)
            _LOG.log(logging.WARNING if kind == "warning" else logging.INFO, "%s", note)


def _camera_option(camera: Any) -> Union[str, tuple[Any, ...]]:
    if isinstance(camera, Camera):
        if camera._preset is not None:
            return camera._preset
        numbers = (float(camera.fx), float(camera.fy), float(camera.cx), float(camera.cy))
        return numbers + (camera.width or 0, camera.height or 0)
    if isinstance(camera, (str, os.PathLike)):
        name = _check.text("camera", os.fspath(camera))
        try:
            _native.parse_camera(name, 640, 480)
        except _native.InputError as error:
            raise _check.of_python(error) from None
        return name
    presets = ", ".join(CAMERA_PRESETS)
    raise _check.refuse("camera", f"an ossa.Camera, {presets} or 'fx,fy,cx,cy'", camera)


def open(  # noqa: A001 - as the command's SOURCE is opened
    source: PathLike,
    camera: Union[Camera, PathLike, None] = None,
    depth_scale: Optional[float] = None,
    fps: Optional[float] = None,
    rotate: Union[int, str] = "auto",
    *,
    depth_format: str = "plain",
    mirrored: bool = False,
    wait_s: float = 0.0,
    keep_waiting: Optional[Callable[[], bool]] = None,
    patience_s: float = 5.0,
) -> Source:
    """Opens a SOURCE, as `ossa track SOURCE` does, and iterates over its depth images.

    Parameters
    ----------
    source : str or path
        "openni:" (first device), "openni:URI", FILE.oni, FILE.xef (Kinect Studio),
        FILE.mkv (Azure Kinect, Femto), a
        bag of ROS 1 or 2, RealSense or Orbbec (FILE.bag, FILE.db3, FILE.mcap, a folder) or
        "BAG#/topic", arrays of NumPy, MATLAB or HDF5 (FILE.npy, .npz, .mat, .h5) or "FILE#name",
        a 16-bit PNG, TIFF or PGM or a folder of them, or a data set of `ossa render`.
    camera : ossa.Camera, str or path, optional
        A preset's name, "fx,fy,cx,cy" in pixels, or a file with intrinsics (.json, .yaml, .xml,
        .txt, .npy), as of `ossa track --camera`. Left out: the source's own, else a preset by the image size, with
        a note in `notes`.
    depth_scale : float, optional
        Units per metre of a recording's depths, 1e-3 to 1e6. Left out: its own, else 1000,
        millimetres.
    fps : float, optional
        Images a second of a recording, in place of its own times. Left out: its own times, else 30.
    rotate : 0, 90, 180, 270 or "auto"
        Degrees by which the images must be rotated clockwise for people to stand upright in them;
        with "auto" that of `camera`, if it has one. The images are not rotated; their cameras carry
        the rotation to the tracker, see Camera.
    depth_format : "plain", "swapped", "inverted", "inverted:FROM" or "disparity"
        Format of the 16-bit values of a recording: depths; depths with swapped bytes; subtracted
        from 65535 or from FROM; raw disparities of a Kinect v1.
    mirrored : bool
        The images are mirrored, as Kinect SDKs and libfreenect2 deliver them, and the intrinsics (the
        source's own or `camera`) are of mirrored images: both are unmirrored. `rotate` is of the
        unmirrored images.
    wait_s : float
        Seconds to wait for a device to be plugged in.
    keep_waiting : function, optional
        Called without arguments ten times a second meanwhile, by the thread that waits: what is
        not true ends the wait, as if the time were over. `lambda: not stop.is_set()` lets another
        thread end it by a threading.Event.
    patience_s : float
        Seconds without an image after which reading a device fails.

    Returns
    -------
    Source
        Iterator of DepthImage: (depth_mm uint16 [H, W], camera, time_s).

    Raises
    ------
    ossa.InputError
        Naming the source and what was expected; while iterating, for a damaged file or an unplugged
        device.

    Examples
    --------
    >>> for depth_mm, camera, time_s in ossa.open("recording.oni"):
    ...     frame = tracker.track(depth_mm, camera, time_s)
    """
    options: dict[str, Any] = {
        "depth_format": _check.text("depth_format", depth_format),
        "mirrored": _check.flag("mirrored", mirrored),
        "wait_s": _check.number("wait_s", wait_s, 0.0, _LONGEST_S),
    }
    if camera is not None:
        options["camera"] = _camera_option(camera)
    if keep_waiting is not None:
        options["keep_waiting"] = _check.function("keep_waiting", keep_waiting)
    if depth_scale is not None:
        options["depth_scale"] = _check.number("depth_scale", depth_scale, 1e-3, 1e6)
    if fps is not None:
        options["fps"] = _check.number("fps", fps, 1e-3, 1e4)
    _check.one_of("rotate", rotate, ROTATIONS)
    if rotate == "auto" and isinstance(camera, Camera) and camera.rotate != 0:
        rotate = camera.rotate
    patience = _check.number("patience_s", patience_s, 1e-3, _LONGEST_S)
    return Source(_check.path("source", source), options, rotate, patience)
