"""ossa.Tracker: depth images in, bodies out."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _check, _method_options, _native
from ._camera import ROTATIONS, Camera, native_camera
from ._frames import Frame, frame_from
from ._models import Models, models_for
from ._names import METHODS, MOUNTS
from ._smoothing import Smoothing, smoothing_option
from ._sources import PathLike, Source
from ._sources import open as open_source

if TYPE_CHECKING:
    from typing_extensions import Unpack

_LOG = logging.getLogger("ossa")
_STEP_S = 1.0 / 30.0  # between frames without times


def _bones_option(bones_m: Any) -> dict[int, list[float]]:
    if bones_m is None:
        return {}
    if not isinstance(bones_m, Mapping):
        raise _check.refuse("bones_m", "a dict of float64 [20] by body id", bones_m)
    return {
        _check.whole("bones_m: id", k, 1, 255): _check.array("bones_m", v, (20,), float).tolist()
        for k, v in bones_m.items()
    }


def _person_option(person: Any, fit: bool, max_users: int) -> list[str]:
    if person is None:
        return []
    if not fit:
        raise _check.InputError("person: expected fit=True with it")
    if not isinstance(person, (list, tuple)):
        return [_check.path("person", person)]
    if len(person) > max_users:
        raise _check.InputError(f"person: expected at most {max_users} files, as max_users says, found {len(person)}")
    return [_check.path("person", one) for one in person]


class Tracker:
    """Tracks people over depth images: the functions of the Kinect SDK's skeleton stream, for any depth
    camera.

    Several trackers may run at once, each in its own thread: the GIL is released while they work.
    Calls of two threads to one tracker are serialised. Results are independent arrays.

    Parameters
    ----------
    method : str
        Reconstruction method, one of ossa.METHODS: "none", "holt", "one-euro", "kalman",
        "shum-ho-2012", "shum-2013", "plantard-2016", "liu-2016", "full-gp", "exemplar", "best".
    physics : bool
        Let a physical character follow the posture (Shum 2013, sec. VII).
    model : path, optional
        Forest, .ossa of `ossa train`. Left out: the shipped one.
    smoothing : str, ossa.Holt, ossa.OneEuro, optional
        Final filter of joints: "none", "default", "smooth", "verysmooth" (the Kinect SDK's),
        "one-euro", or one with your own parameters. Left out: the default of the method; methods
        that are filters get none.
    max_users : int
        Maximum number of people at a time, 1 to 6.
    threads : int
        Threads for several people, 1 to 256. The results do not depend on it.
    seated : bool
        Track only the ten upper joints (the SDK's seated mode); see `mode`.
    near : bool
        Near range: people within 3 m of a level camera only.
    lag : int
        For track_late and run: frames of delay for smoother bodies, 0 (live) to 2.
    parts, probabilities, proposals : bool
        Fill Frame.parts (an eighth of a frame's time), Frame.probabilities (128 bytes per pixel),
        Body.proposals.
    fit : bool
        Fit the body's surface to the depth image if there are refined joints (Body.fit,
        Body.mesh), as `ossa track` does; the method then starts from the mean of fit and refined
        joints.
    refinement, learned, prior, database, pose_network, surface, mesh : path or "none", optional
        Other model files, as of ossa.Models.
    models : ossa.Models, optional
        Models in memory, shared by trackers, in place of files.
    bones_m : dict of int to float64 [20], optional
        Metres, Body.bones_m by Body.id of an earlier run over the same recording: kept constant from
        the first frame to the last. Only for methods that keep bones.
    person : path or list of path, optional
        Person files, .ossaperson of `ossa track --save-person`: the person with id 1 (2, ...) is
        fitted with that shape from the first frame on. Needs `fit`.
    mount : "auto", "level" or "ceiling"
        Mounting of the camera. "auto": level, until a floor far below and a body on it show that it
        is under the ceiling.
    scene : path, optional
        A scene file, .toml: all people in one physics simulation with its objects (Frame.objects), in
        place of `physics`.
    control : "pd" or "motor"
        With physics or a scene: the controller of the character.
    hinges, joint_limits : bool
        With physics or a scene: elbows and knees bend about one axis; joints have human ranges.
    seed : int
        For methods that draw samples.
    METHOD_OPTIONS

    Raises
    ------
    ossa.InputError
        Naming the argument, or the file that is missing or damaged.

    Examples
    --------
    >>> tracker = ossa.Tracker()
    >>> frame = tracker.track(depth_mm, ossa.Camera.preset("kinect-v2"))
    >>> for body in frame.bodies:
    ...     print(body.id, body["Head"])
    """

    @_method_options.takes_method_options
    def __init__(
        self,
        method: str = "best",
        physics: bool = False,
        model: Optional[PathLike] = None,
        smoothing: Smoothing = None,
        max_users: int = 6,
        threads: int = 1,
        seated: bool = False,
        *,
        near: bool = False,
        lag: int = 0,
        parts: bool = True,
        probabilities: bool = False,
        proposals: bool = False,
        fit: bool = True,
        refinement: Optional[PathLike] = None,
        learned: Optional[PathLike] = None,
        prior: Optional[PathLike] = None,
        database: Optional[PathLike] = None,
        pose_network: Optional[PathLike] = None,
        surface: Optional[PathLike] = None,
        mesh: Optional[PathLike] = None,
        models: Optional[Models] = None,
        bones_m: Optional[Mapping[int, npt.ArrayLike]] = None,
        person: Union[PathLike, Sequence[PathLike], None] = None,
        mount: str = "auto",
        scene: Optional[PathLike] = None,
        control: str = "pd",
        hinges: bool = False,
        joint_limits: bool = False,
        seed: int = 1,
        **method_options: Unpack[_method_options.MethodOptions],
    ) -> None:
        given = dict(locals())
        _check.one_of("method", method, METHODS)
        names = ("model", "refinement", "learned", "prior", "database", "pose_network", "surface", "mesh")
        files = {name: given[name] for name in names}
        options = {
            "method": method,
            "physics": _check.flag("physics", physics),
            "mechanics": _method_options.mechanics_option(physics, control, hinges, joint_limits, scene),
            "method_options": _method_options.checked(method, method_options),
            "seated": _check.flag("seated", seated),
            "near": _check.flag("near", near),
            "lag": _check.whole("lag", lag, 0, 2),
            "parts": _check.flag("parts", parts),
            "probabilities": _check.flag("probabilities", probabilities),
            "proposals": _check.flag("proposals", proposals),
            "fit": _check.flag("fit", fit),
            "max_users": _check.whole("max_users", max_users, 1, 6),
            "threads": _check.whole("threads", threads, 1, 256),
            "seed": _check.whole("seed", seed, 0, 2**63 - 1),
            "bones_m": _bones_option(bones_m),
            "person": _person_option(person, fit, max_users),
            "mount": _check.one_of("mount", mount, MOUNTS),
            "scene": _check.optional_path("scene", scene),
        }
        chosen = smoothing_option(smoothing)
        if chosen is not None:
            options["smoothing"] = chosen
        self._models = models_for(method, models, files)
        self._native = _native.Tracker(options, self._models._native)
        self._faces = self._native.faces()
        self._mode = "seated" if seated else "standing"
        self._smoothing = smoothing
        self._time_s: Optional[float] = None

    def track(
        self,
        depth_mm: npt.NDArray[np.uint16],
        camera: Camera,
        time_s: Optional[float] = None,
    ) -> Frame:
        """Tracks the people of one depth image.

        Parameters
        ----------
        depth_mm : uint16 [H, W]
            Millimetres along the optical axis, 0 = no reading. Pixels of a row contiguous (C
            order); a view of a part of a larger image is accepted. It is not copied: do not write
            into it before track returns, or the skeleton mixes two images.
        camera : ossa.Camera
            The camera of the image.
        time_s : float, optional
            Seconds, by any clock that increases from image to image: of milliseconds the logger
            "ossa" warns once. Left out: a thirtieth of a second after the previous image.

        Returns
        -------
        Frame

        Raises
        ------
        ossa.InputError
            For another type, shape or order, an invalid camera, a time that is not finite.
        """
        made = self._native.track(*self._checked(depth_mm, camera, time_s))
        self._log_warning()
        return frame_from(made, self._faces)

    def track_late(
        self,
        depth_mm: npt.NDArray[np.uint16],
        camera: Camera,
        time_s: Optional[float] = None,
    ) -> Optional[Frame]:
        """As track, delayed and smoother: the frame as many images before as the tracker's `lag`,
        with joints smoothed by the frames after it.

        Parameters
        ----------
        depth_mm : uint16 [H, W]
            As of track.
        camera : ossa.Camera
            The camera of the image.
        time_s : float, optional
            As of track.

        Returns
        -------
        Frame or None
            None for the first `lag` images; take_held returns the last frames.
        """
        made = self._native.track_late(*self._checked(depth_mm, camera, time_s))
        self._log_warning()
        return None if made is None else frame_from(made, self._faces)

    def take_held(self) -> Optional[Frame]:
        """After track_late, at the end of a stream: the next held frame; None when all were
        returned."""
        made = self._native.take_held()
        return None if made is None else frame_from(made, self._faces)

    def _checked(
        self, depth_mm: Any, camera: Camera, time_s: Optional[float]
    ) -> tuple[npt.NDArray[np.uint16], tuple[Any, ...], float, int]:
        image = _check.image(depth_mm)
        numbers = native_camera(camera, image)
        if time_s is None:
            seconds = 0.0 if self._time_s is None else self._time_s + _STEP_S
        else:
            seconds = _check.number("time_s", time_s, -1e12, 1e12)
        self._time_s = seconds
        return image, numbers, seconds, ROTATIONS.index(camera.rotate)

    def run(self, source: Union[PathLike, Source]) -> Iterator[Frame]:
        """Tracks a whole source, frame by frame, as `ossa track SOURCE` does (of a recording, with
        lag=2).

        The beginning of a recording is searched first: for the rotation of the camera, if its
        rotate is "auto"; and, for images that state no camera, for a camera with a narrower view
        (depth aligned to colour images) with which people are detected with much higher
        confidence. That camera is then the source's, and is reported in its notes.

        Parameters
        ----------
        source : path or Source
            A SOURCE of ossa.open, or an opened Source.
        """
        opened = source if isinstance(source, Source) else open_source(source)
        return self._run(opened)

    def _run(self, source: Source) -> Iterator[Frame]:
        self._find_camera(source)
        self._find_upright(source)
        failure: Optional[_native.InputError] = None
        try:
            try:
                yield from self._run_on(source)
            except _native.InputError as error:
                failure = error  # what was tracked before it comes first
            while (held := self.take_held()) is not None:
                yield held
        finally:
            # Of a run that was given up: they are no frames of what is tracked next.
            while self._native.take_held() is not None:
                pass
        if failure is not None:
            raise failure

    def _log_warning(self, where: str = "") -> None:
        """Of times that cannot be seconds, once."""
        warning = self._native.take_warning()
        if warning is not None:
            _LOG.warning("%s%s", where, warning)

    def _find_camera(self, source: Source) -> None:
        if "camera" in source._options or source.is_live:
            return
        try:
            found = self._native.find_camera(source.name, source._options)
        except _native.InputError:
            return  # told of when its turn comes
        if found is not None:
            source._take_camera(*found)

    def _find_upright(self, source: Source) -> None:
        if source._rotate != "auto" or source.is_live:
            return
        try:
            self._native.find_upright(source.name, source._options)
        except _native.InputError:
            pass  # told of when its turn comes

    def _run_on(self, source: Source) -> Iterator[Frame]:
        turn = ROTATIONS.index(source._rotate)
        while (seen := source._wait_for(lambda ms: self._native.track_next(source._native, ms, turn))) is not None:
            _, made, self._time_s, _ = seen
            self._log_warning(f"{source.name}: ")
            if made is not None:
                yield frame_from(made, self._faces)

    def choose_users(self, ids: Union[int, Sequence[int], None] = None) -> None:
        """Track only these people fully, the others by position (the SDK's AppChoosesSkeletons).

        Parameters
        ----------
        ids : int or sequence of int, optional
            Body.id of each. None: everybody, as at the start.
        """
        if ids is None:
            self._native.choose_users(None)
            return
        if isinstance(ids, (int, np.integer, np.ndarray)):
            ids = np.atleast_1d(ids).tolist()
        if not isinstance(ids, (list, tuple, set, frozenset, range)):
            raise _check.refuse("ids", "body ids, or None for everybody", ids)
        self._native.choose_users([_check.whole("ids", i, 0, 2**31 - 1) for i in ids])

    @property
    def mode(self) -> str:
        """"standing" (all 20 joints) or "seated" (the ten upper ones). May be set between frames."""
        return self._mode

    @mode.setter
    def mode(self, mode: str) -> None:
        chosen = _check.one_of("mode", mode, ("standing", "seated"))
        self._native.set_seated(chosen == "seated")
        self._mode = chosen

    @property
    def smoothing(self) -> Smoothing:
        """The final filter of joints, as given to Tracker. May be set between frames; None: the
        default of the method."""
        return self._smoothing

    @smoothing.setter
    def smoothing(self, smoothing: Smoothing) -> None:
        self._native.set_smoothing(smoothing_option(smoothing))
        self._smoothing = smoothing

    @property
    def method(self) -> str:
        """The method of reconstruction."""
        return self._models.method

    @property
    def rotation(self) -> int:
        """The current clockwise rotation of the images before people are detected, degrees."""
        return 90 * self._native.quarter_turns()

    def reset(self) -> None:
        """Resets all state: another recording begins."""
        self._native.reset()
        self._time_s = None


Tracker.__doc__ = (Tracker.__doc__ or "").replace("METHOD_OPTIONS", _method_options.HELP)
