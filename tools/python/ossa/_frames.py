"""Results of the tracker for an image: ossa.Frame, its bodies, and their fits.

They compare by identity (eq=False): comparing arrays gives no single bool, and `body in
frame.bodies` must work.
"""

from __future__ import annotations

import dataclasses
from typing import Any, Iterator, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _native
from ._names import JOINTS, STATES, Joint

Floats = npt.NDArray[np.float64]

_STATES = np.array(STATES)
_EDGES = {"right": 1, "left": 2, "top": 4, "bottom": 8}


@dataclasses.dataclass(frozen=True, eq=False)
class Proposals:
    """Proposals of one joint by the forest: the modes of its density estimate, best first.

    Attributes
    ----------
    positions : float64 [n, 3]
        Camera space, metres, inside the body.
    confidence : float64 [n]
        In [0, 1].
    seen : bool [n]
        False: inferred from the other joints, without votes of pixels near it.
    """

    positions: Floats
    confidence: Floats
    seen: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.positions)


def proposals_from(rows: Floats) -> Proposals:
    """Of the extension's float64 [n, 5]."""
    return Proposals(rows[:, :3].copy(), rows[:, 3].copy(), rows[:, 4] > 0.5)


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Mesh:
    """The triangle mesh of a fitted body.

    Attributes
    ----------
    vertices : float64 [V, 3]
        Camera space, metres.
    faces : int32 [F, 3]
        Vertex indices of each triangle, counter-clockwise from outside; the same for all bodies.
    """

    vertices: Floats
    faces: npt.NDArray[np.int32]

    def __repr__(self) -> str:
        return f"<ossa.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces>"


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Fit:
    """The body fitted to the depth image, unless Tracker(fit=False).

    Attributes
    ----------
    joints : float64 [20, 3]
        The joints of that body, camera space, metres.
    shape : float64 [10]
        Components of body shape and clothes, standard deviations from the mean body.
    stature_m : float
        Body height, metres, by the shape of this frame alone.
    explained : float
        Share of the person's pixels within 3 cm of the surface, [0, 1].
    score : float
        `explained` less the share of the surface that the camera sees through; 1 is perfect.
    median_residual_m : float
        Median distance of the pixels from the surface, metres.
    residuals_m : float64 [18]
        Root mean square distance of each segment's pixels (ossa.SEGMENTS), metres; NaN without.
    orientations : float64 [18, 4]
        Quaternions w x y z, camera from segment: rotation relative to a body that stands facing +z
        with its left at +x.
    covariance_m2 : float64 [20, 3, 3]
        Covariance of the error of each joint, camera axes, square metres.
    mesh : Mesh
        Its mesh.
    """

    joints: Floats
    shape: Floats
    stature_m: float
    explained: float
    score: float
    median_residual_m: float
    residuals_m: Floats
    orientations: Floats
    covariance_m2: Floats
    _skin: Optional[_native.Skin]  # to be posed; None once that is done
    _faces: npt.NDArray[np.int32]
    _mesh: Optional[Mesh] = None

    @property
    def mesh(self) -> Mesh:
        """The mesh, computed at first access."""
        if self._mesh is None:
            assert self._skin is not None
            object.__setattr__(self, "_mesh", Mesh(self._skin.vertices(), self._faces.copy()))
        assert self._mesh is not None
        return self._mesh

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_mesh": self.mesh, "_skin": None}

    def __repr__(self) -> str:
        return f"<ossa.Fit: {self.stature_m:.2f} m tall, {self.explained:.0%} explained>"


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Body:
    """One person in a Frame. Index j of an array of joints is ossa.JOINTS[j]; body["Head"] is the
    position of that joint. Positions are of camera space, metres.

    Attributes
    ----------
    id : int
        From 1; constant while the person is tracked.
    tracked : bool
        False: only `position` is known (see Tracker.choose_users); joints are NaN, not_tracked.
    position : float64 [3]
        Centroid of the person's visible surface.
    joints : float64 [20, 3]
        The skeleton.
    states : str [20]
        "tracked" (seen in the image), "inferred" (estimated from its surroundings) or "not_tracked"
        (merely plausible for the rest of the body).
    confidence : float64 [20]
        Of the observation, by the forest, [0, 1].
    reliability : float64 [20]
        R_i of Shum 2013, eq. 8: plausibility of movement and bone lengths, [0, 1].
    orientations : float64 [20, 4]
        Quaternions w x y z, camera from bone: the y axis of the bone that ends in the joint points
        from the parent to the joint (the SDK's absolute orientations).
    hierarchical_orientations : float64 [20, 4]
        The rotation of each bone relative to its parent, w x y z.
    raw : float64 [20, 3]
        Joints of the forest from this image alone.
    refined : float64 [20, 3] or None
        The joints after cascaded refinement; None without it.
    reconstructed : float64 [20, 3]
        The joints after the reconstruction method, before physics and smoothing.
    bones_m : float64 [20] or None
        Length of the bone that ends in each joint, metres (0 of the root), over all frames so far;
        None for methods that do not keep bone lengths.
    clipped : frozenset of str
        Image borders that cut the person: "left", "right", "top", "bottom".
    person_score : float
        Probability of being a person, by forest and pose network, [0, 1].
    proposals : tuple of 20 Proposals, or None
        With Tracker(proposals=True).
    fit : Fit or None
        The body fitted to the depth image, unless Tracker(fit=False), where enough of the person shows.
    mesh : Mesh or None
        Its skin.
    """

    id: int
    tracked: bool
    position: Floats
    joints: Floats
    states: npt.NDArray[np.str_]
    confidence: Floats
    reliability: Floats
    orientations: Floats
    hierarchical_orientations: Floats
    raw: Floats
    refined: Optional[Floats]
    reconstructed: Floats
    bones_m: Optional[Floats]
    clipped: frozenset[str]
    person_score: float
    proposals: Optional[tuple[Proposals, ...]]
    fit: Optional[Fit]

    @property
    def mesh(self) -> Optional[Mesh]:
        """The fitted body's mesh: vertices float64 [V, 3], camera space, metres, and faces int32
        [F, 3]; None without a fit."""
        return None if self.fit is None else self.fit.mesh

    def __getitem__(self, joint: Union[str, int, Joint]) -> Floats:
        """float64 [3], metres: the joint's position by name or index."""
        if isinstance(joint, str):
            _check.one_of("joint", joint, JOINTS)
            return np.asarray(self.joints[JOINTS.index(joint)])
        return np.asarray(self.joints[_check.whole("joint", joint, 0, len(JOINTS) - 1)])

    def __iter__(self) -> Iterator[Floats]:
        """The joints' positions."""
        return iter(self.joints)

    def __repr__(self) -> str:
        count = int((self.states == "tracked").sum())
        return f"<ossa.Body {self.id}: {count} joints tracked>"


@dataclasses.dataclass(frozen=True, eq=False)
class Thing:
    """An object of Tracker(scene=...) in one frame: camera space, metres.

    Attributes
    ----------
    name : str
        Its name in the scene file.
    position, velocity_m_s : float64 [3]
        Of its centre; metres, metres per second.
    orientation : float64 [4]
        Quaternion w x y z, camera from thing.
    held_by : tuple of int
        Body.id of each person who holds it.
    """

    name: str
    position: Floats
    orientation: Floats
    velocity_m_s: Floats
    held_by: tuple[int, ...]


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Frame:
    """The result of the tracker for one depth image.

    Attributes
    ----------
    bodies : list of Body
        By id.
    users : uint8 [H, W]
        Id of the body that each pixel belongs to, 0 nobody.
    parts : uint8 [H, W] or None
        Label of each pixel, ossa.PARTS; None with Tracker(parts=False).
    probabilities : float32 [H, W, C] or None
        Probability of each part at each pixel, by the trees alone; with Tracker(probabilities=True).
        Of the shipped forest c is the index in ossa.PARTS; 0 outside people.
    floor : float64 [4] or None
        a b c d of the floor a x + b y + c z + d = 0, metres, (a, b, c) of length 1 and upwards.
    tilt_down_rad : float or None
        Downward tilt of the sensor, from the floor; negative: it looks up.
    time_s : float
        Seconds.
    index : int
        Number of the frame, from 0.
    ms : dict
        Milliseconds spent on "segment", "classify", "propose", "reconstruct", "physics", "total", and on "fit", a part of "reconstruct".
    objects : tuple of Thing
        Of Tracker(scene=...), once the scene has a floor.
    """

    bodies: list[Body]
    users: npt.NDArray[np.uint8]
    parts: Optional[npt.NDArray[np.uint8]]
    probabilities: Optional[npt.NDArray[np.float32]]
    floor: Optional[Floats]
    tilt_down_rad: Optional[float]
    time_s: float
    index: int
    ms: Mapping[str, float]
    objects: tuple[Thing, ...] = ()

    def __repr__(self) -> str:
        return f"<ossa.Frame {self.index} at {self.time_s:.3f} s: {len(self.bodies)} bodies>"

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row for each joint of each tracked body: frame, time_s, id, joint,
        x, y, z (metres), state, confidence, reliability. Raises ImportError without pandas."""
        from ._tables import table_of_joints

        bodies = [body for body in self.bodies if body.tracked]
        return table_of_joints(
            frames=[self.index] * len(bodies),
            times=[self.time_s] * len(bodies),
            ids=[body.id for body in bodies],
            joints=[body.joints for body in bodies],
            states=[body.states for body in bodies],
            confidence=[body.confidence for body in bodies],
            reliability=[body.reliability for body in bodies],
        )


def _fit_from(made: Optional[dict[str, Any]], faces: Any) -> Optional[Fit]:
    if made is None:
        return None
    return Fit(**made, _faces=faces)


def _body_from(made: dict[str, Any], faces: Any) -> Body:
    edges = frozenset(name for name, bit in _EDGES.items() if made["clipped_edges"] & bit)
    known = (made["id"], made["tracked"], made["position"])
    if not made["tracked"]:
        unknown = np.full((20, 3), np.nan)
        turns = np.full((20, 4), np.nan)
        zeros = np.zeros(20)
        return Body(
            *known, unknown, _STATES[np.zeros(20, int)], zeros, zeros.copy(), turns, turns.copy(),
            unknown.copy(), None, unknown.copy(), None, edges, made["person_score"], None, None,
        )  # fmt: skip
    proposals = made.get("proposals")
    return Body(
        *known,
        joints=made["joints"],
        states=_STATES[made["states"]],
        confidence=made["confidence"],
        reliability=made["reliability"],
        orientations=made["orientations"],
        hierarchical_orientations=made["hierarchical_orientations"],
        raw=made["raw"],
        refined=made["refined"],
        reconstructed=made["reconstructed"],
        bones_m=made["bones_m"],
        clipped=edges,
        person_score=made["person_score"],
        proposals=None if proposals is None else tuple(proposals_from(p) for p in proposals),
        fit=_fit_from(made.get("fit"), faces),
    )


def frame_from(
    made: dict[str, Any], faces: Optional[npt.NDArray[np.int32]]
) -> Frame:
    return Frame(
        bodies=[_body_from(body, faces) for body in made["bodies"]],
        users=made["users"],
        parts=made["parts"],
        probabilities=made["probabilities"],
        floor=made["floor"],
        tilt_down_rad=made["tilt_down_rad"],
        time_s=made["time_s"],
        index=made["index"],
        ms=made["ms"],
        objects=tuple(Thing(**thing) for thing in made["objects"]),
    )
