"""ossa.Sequence: recorded skeletons."""

from __future__ import annotations

from typing import Any, Iterable, Iterator, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from . import _check
from ._frames import Frame
from ._names import STATES
from ._rows import check_rows

Floats = npt.NDArray[np.float64]

_NOBODY = -1  # id of the row of a frame without bodies
_NO_STATE = -1  # code of an empty state, in the extension
_STATE_NAMES = np.array(("",) + STATES)  # by code + 1
_COLUMNS = {  # name: shape of a row, default value
    "floor": ((4,), np.nan),
    "confidence": ((20,), np.nan),
    "reliability": ((20,), np.nan),
    "orientations": ((20, 4), np.nan),
    "bones_m": ((20,), np.nan),
}


def _states_option(states: Any, rows: int) -> npt.NDArray[np.int8]:
    if states is None:
        return np.full((rows, 20), _NO_STATE, dtype=np.int8)
    words = _check.array("states", states, (rows, 20), np.str_)
    codes = np.full(words.shape, -2, dtype=np.int8)
    for code, word in enumerate(_STATE_NAMES.tolist()):
        codes[words == word] = code - 1
    if (codes == -2).any():
        raise _check.refuse("states", ", ".join(STATES) + " or ''", str(words[codes == -2][0]))
    return codes


class Sequence:
    """A recording of skeletons: R rows, one for each body of each frame, in order of time.

    For a recording of one person, R is its number of frames F. A frame without bodies is a row of its
    own, with id -1 and NaN joints. Index j of an array of joints is ossa.JOINTS[j].

    Parameters (each is also an attribute)
    ----------
    times : float64 [R]
        Seconds, not falling. Rows of one frame have one time.
    joints : float64 [R, 20, 3]
        Camera space (x to the sensor's left, y up, z forward), metres; NaN: an absent joint.
    states : str [R, 20], optional
        "tracked", "inferred", "not_tracked", or "" if unknown.
    ids : int64 [R], optional
        Id of the person of each row, 0 or more; -1: no body. Left out: all of one person, 1.
    frames : int64 [R], optional
        Numbers of the frames. Left out: a new one with each new time.
    confidence, reliability : float64 [R, 20], optional
        In [0, 1]; NaN where unknown.
    orientations : float64 [R, 20, 4], optional
        Quaternions w x y z, camera from bone; NaN where unknown.
    floor : float64 [R, 4], optional
        a b c d of a x + b y + c z + d = 0, metres, normal up; NaN where none is known.
    bones_m : float64 [R, 20], optional
        Metres: bone lengths estimated by cascaded refinement from this frame alone; NaN without.
    sensor : str
        Origin of the joints: ossa corrects known errors of "Kinect v2" and "refined joints".

    Attributes
    ----------
    source : str
        The source file.
    warnings : list of str
        Warnings about oddities of the file and how they were read.
    visible : int8 [R, 20]
        Of truth files: 1 visible, 0 hidden; -1 where unknown.

    Raises
    ------
    ossa.InputError
        Naming the argument, the shape expected and what was found.
    """

    def __init__(
        self,
        times: npt.ArrayLike,
        joints: npt.ArrayLike,
        states: Optional[npt.ArrayLike] = None,
        *,
        ids: Optional[npt.ArrayLike] = None,
        frames: Optional[npt.ArrayLike] = None,
        confidence: Optional[npt.ArrayLike] = None,
        reliability: Optional[npt.ArrayLike] = None,
        orientations: Optional[npt.ArrayLike] = None,
        floor: Optional[npt.ArrayLike] = None,
        bones_m: Optional[npt.ArrayLike] = None,
        sensor: str = "",
    ) -> None:
        self.times: Floats = _check.array("times", times, (None,), np.float64)
        rows = len(self.times)
        if not np.isfinite(self.times).all():
            raise _check.refuse("times", "finite seconds", float("nan"))
        self.joints: Floats = _check.array("joints", joints, (rows, 20, 3), np.float64)
        if np.isinf(self.joints).any():
            raise _check.refuse("joints", "metres, or NaN for an absent joint", float("inf"))
        self._codes = _states_option(states, rows)
        everyone = np.ones(rows, dtype=np.int64)
        given = everyone if ids is None else ids
        self.ids: npt.NDArray[np.int64] = _check.array("ids", given, (rows,), np.int64)
        if ((self.ids < _NOBODY) | (self.ids > 2**31 - 1)).any():
            raise _check.refuse("ids", "0 to 2147483647, or -1 for nobody", int(self.ids.min()))
        steps = np.concatenate([[0], np.cumsum(np.diff(self.times) != 0)]) if rows else []
        numbers = steps if frames is None else frames
        self.frames: npt.NDArray[np.int64] = _check.array("frames", numbers, (rows,), np.int64)
        optional = (floor, confidence, reliability, orientations, bones_m)
        for (name, (shape, nothing)), value in zip(_COLUMNS.items(), optional):
            filled = np.full((rows,) + shape, nothing) if value is None else value
            setattr(self, name, _check.array(name, filled, (rows,) + shape, np.float64))
        self.visible: npt.NDArray[np.int8] = np.full((rows, 20), _NO_STATE, dtype=np.int8)
        self.sensor = _check.text("sensor", sensor)
        self.source = ""
        self.columns = ""
        self.warnings: list[str] = []

    floor: Floats
    confidence: Floats
    reliability: Floats
    orientations: Floats
    bones_m: Floats

    @property
    def states(self) -> npt.NDArray[np.str_]:
        """str [R, 20]: "tracked", "inferred", "not_tracked", or "" where unknown."""
        words: npt.NDArray[np.str_] = _STATE_NAMES[self._codes + 1]
        return words

    @property
    def people(self) -> list[int]:
        """The ids that occur."""
        return [int(i) for i in np.unique(self.ids) if i != _NOBODY]

    def person(self, id: int) -> Sequence:
        """The rows of one person alone.

        Parameters
        ----------
        id : int
            One of `people`.
        """
        wanted = _check.whole("id", id, 0, 2**31 - 1)
        if wanted not in self.people:
            raise _check.refuse("id", f"one of {self.people}", wanted)
        return self[self.ids == wanted]

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[Sequence]:
        """Its rows, one by one."""
        return (self[row] for row in range(len(self)))

    def __getitem__(self, rows: Any) -> Sequence:
        """Some rows: a slice, a bool [R], or indices."""
        try:
            chosen = np.arange(len(self))[rows]
        except (IndexError, TypeError, ValueError):
            raise _check.refuse("rows", "a slice, a bool [R] or indices of rows", rows) from None
        chosen = np.atleast_1d(chosen)
        return from_native({k: v[chosen] if k in _ROWS else v for k, v in _to_native(self).items()})

    def __repr__(self) -> str:
        return f"<ossa.Sequence of {len(self)} rows, {len(self.people)} people>"

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row for each joint of each body of each frame: frame, time_s, id,
        joint, x, y, z (metres), state, confidence, reliability. Raises ImportError without
        pandas."""
        from ._tables import table_of_joints

        some = self.ids != _NOBODY
        return table_of_joints(
            self.frames[some], self.times[some], self.ids[some], self.joints[some],
            self.states[some], self.confidence[some], self.reliability[some],
        )  # fmt: skip

    @staticmethod
    def from_frames(frames: Iterable[Frame]) -> Sequence:
        """Skeletons for files and methods.

        Parameters
        ----------
        frames : iterable of Frame
            Results of Tracker.track or Tracker.run.
        """
        return _sequence_of(frames)


_ROWS = ("frames", "ids", "times", "joints", "states", "visible") + tuple(_COLUMNS)


def _to_native(sequence: Sequence) -> dict[str, Any]:
    if not isinstance(sequence, Sequence):
        raise _check.refuse("sequence", "an ossa.Sequence", sequence)
    made = {name: getattr(sequence, name) for name in _ROWS if name != "states"}
    made["states"] = sequence._codes
    for name in ("source", "sensor", "columns", "warnings"):
        made[name] = getattr(sequence, name)
    checked = Sequence(made["times"], made["joints"], **{k: made[k] for k in ("ids", "frames")},
                       **{k: made[k] for k in _COLUMNS}, sensor=made["sensor"])  # fmt: skip
    made.update({name: getattr(checked, name) for name in ("times", "joints", "ids", "frames")})
    made.update({name: getattr(checked, name) for name in _COLUMNS})
    return made


def to_rows(sequence: Sequence) -> dict[str, Any]:
    """Columns for files and methods, which accept less than Sequence does (check_rows)."""
    rows = _to_native(sequence)
    check_rows(rows)
    return rows


def from_native(made: dict[str, Any]) -> Sequence:
    """A Sequence of the columns that the extension gives."""
    sequence = Sequence(
        made["times"], made["joints"], ids=made["ids"], frames=made["frames"],
        **{name: made[name] for name in _COLUMNS}, sensor=made["sensor"],
    )  # fmt: skip
    sequence._codes = made["states"]
    sequence.visible = made["visible"]
    sequence.source = made["source"]
    sequence.columns = made["columns"]
    sequence.warnings = list(made["warnings"])
    return sequence


_OF_BODIES = {"joints": (20, 3), "confidence": (20,), "reliability": (20,), "orientations": (20, 4)}


class _Row(NamedTuple):
    """The columns of a frame and one of its bodies, without images and fits."""

    frame: int
    time_s: float
    floor: Floats
    id: int
    states: npt.NDArray[np.str_]
    values: tuple[Floats, ...]  # as _OF_BODIES


def _rows_of(frame: Frame) -> Iterator[_Row]:
    floor = np.full(4, np.nan) if frame.floor is None else frame.floor
    bodies = [body for body in frame.bodies if body.tracked]
    for body in bodies:
        values = tuple(getattr(body, name) for name in _OF_BODIES)
        yield _Row(frame.index, frame.time_s, floor, body.id, body.states, values)
    if not bodies:
        nothing = tuple(np.full(shape, np.nan) for shape in _OF_BODIES.values())
        yield _Row(frame.index, frame.time_s, floor, _NOBODY, np.full(20, ""), nothing)


def _sequence_of(frames: Iterable[Frame]) -> Sequence:
    rows: list[_Row] = []
    for frame in frames:
        if not isinstance(frame, Frame):
            raise _check.refuse("frames", "frames of ossa.Tracker", frame)
        rows += _rows_of(frame)
    columns = {
        name: np.array([row.values[i] for row in rows], dtype=np.float64).reshape((-1,) + shape)
        for i, (name, shape) in enumerate(_OF_BODIES.items())
    }
    return Sequence(
        [row.time_s for row in rows],
        columns["joints"],
        np.array([row.states for row in rows], np.str_).reshape(-1, 20),
        ids=[row.id for row in rows],
        frames=[row.frame for row in rows],
        confidence=columns["confidence"],
        reliability=columns["reliability"],
        orientations=columns["orientations"],
        floor=np.array([row.floor for row in rows], dtype=np.float64).reshape(-1, 4),
    )
