"""ossa.Camera."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _native
from ._names import CAMERA_PRESETS

ROTATIONS = (0, 90, 180, 270, "auto")

# The default image size of each camera, width x height.
_USUAL_SIZE = {
    "kinect-v1": (640, 480), "kinect-v2": (512, 424), "azure-nfov": (640, 576),
    "azure-wfov": (512, 512), "xtion": (640, 480), "d415": (1280, 720), "d435": (848, 480),
    "d455": (848, 480), "femto": (640, 576), "kinect-v1-color": (640, 480),
    "kinect-v2-color": (1920, 1080), "azure-color": (1280, 720), "d415-color": (1280, 720),
    "d435-color": (1280, 720),
}  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Camera:
    """A pinhole depth camera without distortion: intrinsics and mounting.

    Camera space is metres, right-handed, origin at the sensor, x to the sensor's left, y up, z
    forward (the Kinect SDK's skeleton space): u = cx - fx x / z, v = cy - fy y / z, pixel centres
    at whole numbers, u to the right, v down.

    Parameters
    ----------
    fx, fy : float
        Focal lengths, pixels, 0.1 to 1e6.
    cx, cy : float
        Principal point, pixels from the centre of the upper left pixel.
    width, height : int, optional
        The image size of these intrinsics, pixels. For images of another size they are scaled.
        Left out: they apply to images of any size.
    rotate : 0, 90, 180, 270 or "auto"
        Degrees by which its images must be rotated clockwise for people to stand upright in them.
        "auto" detects it from the people seen. Results stay in the space and the images of the
        camera as mounted, not rotated.

    Raises
    ------
    ossa.InputError
        For invalid intrinsics.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    width: Optional[int] = None
    height: Optional[int] = None
    rotate: Union[int, str] = 0
    _preset: Optional[str] = dataclasses.field(default=None, repr=False)

    def __post_init__(self) -> None:
        for name, least in (("fx", 0.1), ("fy", 0.1), ("cx", -1e6), ("cy", -1e6)):
            _check.number(f"camera: {name}", getattr(self, name), least, 1e6)
        if (self.width is None) != (self.height is None):
            raise _check.refuse("camera", "width and height together", None)
        for name in ("width", "height"):
            if getattr(self, name) is not None:
                _check.whole(f"camera: {name}", getattr(self, name), 1, 8192)
        _check.one_of("camera: rotate", self.rotate, ROTATIONS)

    @staticmethod
    def preset(
        name: str,
        width: Optional[int] = None,
        height: Optional[int] = None,
        rotate: Union[int, str] = 0,
    ) -> Camera:
        """The camera of that name, with published intrinsics.

        Your own calibration is more accurate by some pixels. Without a size it applies to images of
        any size that the sensor delivers, cropped and scaled as the sensor does.

        Parameters
        ----------
        name : str
            One of ossa.CAMERA_PRESETS: "kinect-v1", "kinect-v2", "azure-nfov", "azure-wfov",
            "xtion", "d415", "d435", "d455", "femto"; for depth aligned to colour images
            "kinect-v1-color", "kinect-v2-color", "azure-color", "d415-color", "d435-color".
        width, height : int, optional
            The images' size.
        rotate : 0, 90, 180, 270 or "auto"
            As of Camera.
        """
        _check.one_of("name", name, CAMERA_PRESETS)
        if (width is None) != (height is None):
            raise _check.refuse("camera", "width and height together", None)
        usual = _USUAL_SIZE[name]
        w = usual[0] if width is None else _check.whole("width", width, 1, 8192)
        h = usual[1] if height is None else _check.whole("height", height, 1, 8192)
        fx, fy, cx, cy, _, _ = _native.preset_camera(name, w, h)
        return Camera(fx, fy, cx, cy, w, h, rotate, name if width is None else None)

    def for_size(self, width: int, height: int) -> Camera:
        """This camera for images of another size: intrinsics scaled.

        Parameters
        ----------
        width, height : int
            Pixels.
        """
        w = _check.whole("width", width, 1, 8192)
        h = _check.whole("height", height, 1, 8192)
        if self._preset is not None:
            return Camera.preset(self._preset, w, h, self.rotate)
        if self.width is None or self.height is None:
            return dataclasses.replace(self, width=w, height=h)
        sx, sy = w / self.width, h / self.height
        return Camera(self.fx * sx, self.fy * sy, self.cx * sx, self.cy * sy, w, h, self.rotate)

    def points(self, depth_mm: npt.NDArray[np.uint16]) -> npt.NDArray[np.float64]:
        """Back-projects a depth image to points of camera space.

        Parameters
        ----------
        depth_mm : uint16 [H, W]
            Millimetres along the optical axis, 0 = no reading.

        Returns
        -------
        float64 [H, W, 3]
            x y z, metres; NaN where there is no reading.
        """
        depth = _check.array("depth_mm", depth_mm, (None, None), np.uint16)
        height, width = depth.shape
        camera = self.for_size(width, height)
        z = np.where(depth > 0, depth * 1e-3, np.nan)
        v, u = np.mgrid[0:height, 0:width]
        x = (camera.cx - u) * z / camera.fx
        y = (camera.cy - v) * z / camera.fy
        return np.stack([x, y, z], axis=-1)

    def project(self, points_m: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Projects points of camera space into the image.

        Parameters
        ----------
        points_m : float64 [..., 3]
            x y z, metres, z > 0.

        Returns
        -------
        float64 [..., 2]
            u v, pixels, at this camera's image size.
        """
        try:
            points = np.asarray(points_m, dtype=np.float64)
        except (TypeError, ValueError):
            raise _check.refuse("points_m", "float64 [..., 3]", points_m) from None
        if points.ndim < 1 or points.shape[-1] != 3:
            raise _check.refuse("points_m", "float64 [..., 3]", points)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = self.cx - self.fx * points[..., 0] / points[..., 2]
            v = self.cy - self.fy * points[..., 1] / points[..., 2]
        return np.stack([u, v], axis=-1)


def native_camera(camera: Any, depth_mm: npt.NDArray[Any]) -> tuple[Any, ...]:
    """(fx, fy, cx, cy, width, height) for the extension; 0 x 0: of whatever size the image has."""
    if not isinstance(camera, Camera):
        raise _check.refuse("camera", "an ossa.Camera", camera)
    if camera._preset is not None and depth_mm.ndim == 2 and min(depth_mm.shape) > 0:
        shape = (min(depth_mm.shape[1], 8192), min(depth_mm.shape[0], 8192))
        if shape != (camera.width, camera.height):
            camera = camera.for_size(*shape)
    width, height = camera.width or 0, camera.height or 0
    return (
        float(camera.fx), float(camera.fy), float(camera.cx), float(camera.cy), width, height,
    )  # fmt: skip
