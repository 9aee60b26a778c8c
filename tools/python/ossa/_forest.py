"""ossa.Forest: body parts of pixels, and joint proposals."""

from __future__ import annotations

import json
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _native
from ._camera import Camera, native_camera
from ._sources import PathLike
from ._frames import Proposals, proposals_from


def _mask_option(mask: Any) -> Any:
    return None if mask is None else _check.plain("mask", "bool or uint8 [height, width]", mask)


class Forest:
    """A body part forest (Shotton et al. 2011): pixels to class probabilities to joint proposals.

    It works on single images and does not detect people: the given pixels are assumed to show one
    person. ossa.Tracker detects people.

    Parameters
    ----------
    path : path, optional
        .ossa of `ossa train`. Left out: the shipped forest.
    """

    def __init__(self, path: Optional[PathLike] = None) -> None:
        self._native = _native.Forest(_check.optional_path("path", path))

    @property
    def classes(self) -> list[str]:
        """Names of the C classes; 0 is the background. Of the shipped forest ossa.PARTS."""
        return self._native.classes()

    @property
    def targets(self) -> list[str]:
        """Names of the proposed targets; of the shipped forest the 20 joints."""
        return self._native.targets()

    @property
    def card(self) -> dict[str, Any]:
        """Training data and accuracy, as `ossa info` shows them."""
        card = json.loads(self._native.card() or "{}")
        return dict(card)

    def classify(
        self,
        depth_mm: npt.NDArray[np.uint16],
        camera: Camera,
        mask: Optional[npt.NDArray[Any]] = None,
    ) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.float32]]:
        """Classifies the pixels of one person.

        Parameters
        ----------
        depth_mm : uint16 [H, W]
            Millimetres along the optical axis, 0 = no reading; C order. It is not copied.
        camera : ossa.Camera
            The camera of the image.
        mask : bool or uint8 [H, W], optional
            Not 0 at the person's pixels, as `frame.users == body.id`. Left out: all pixels with a
            reading; the image must then show one person and nothing else.

        Returns
        -------
        parts : uint8 [H, W]
            The most likely class, after relabelling by the proposed joints; 0 outside the person.
        probabilities : float32 [H, W, C]
            Of each class by the trees alone, sum 1; 0 outside the person.
        """
        image = _check.image(depth_mm)
        return self._native.classify(image, native_camera(camera, image), _mask_option(mask))

    def propose(
        self,
        depth_mm: npt.NDArray[np.uint16],
        camera: Camera,
        mask: Optional[npt.NDArray[Any]] = None,
    ) -> dict[str, Proposals]:
        """Joint proposals of one person: the modes of each target's density estimate.

        Parameters
        ----------
        depth_mm, camera, mask
            As of classify.

        Returns
        -------
        dict of str to Proposals
            By name of the target, each best first; camera space, metres.
        """
        image = _check.image(depth_mm)
        made = self._native.propose(image, native_camera(camera, image), _mask_option(mask))
        return {name: proposals_from(rows) for name, rows in made.items()}
