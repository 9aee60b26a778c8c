"""Checks of the rows of a Sequence before they are written or reconstructed, with the bounds of the
file readers: written files must be readable."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from . import _check

Floats = npt.NDArray[np.float64]
Rows = Mapping[str, Any]  # the columns of a Sequence by name

# The bounds of the readers (recon/files).
_FARTHEST_M = 1e6
_LONGEST_BONE_M = 2.0
_OFF_UNIT_LENGTH = 1e-2  # of a quaternion's length


def _check_times(rows: Rows) -> None:
    times = rows["times"]
    falls = np.flatnonzero(np.diff(times) < 0)
    if len(falls) > 0:
        before, after = times[falls[0] : falls[0] + 2].tolist()
        raise _check.InputError(
            f"times: expected seconds that do not fall from row to row, found {after:g} after {before:g}"
        )


def _check_ids(rows: Rows) -> None:
    """Each id once per frame; a frame is a run of rows with equal number and time."""
    somebody = rows["ids"] >= 0
    if not somebody.any():
        return
    steps = (np.diff(rows["frames"]) != 0) | (np.diff(rows["times"]) != 0)
    moments = np.concatenate([[0], np.cumsum(steps)])
    pairs = np.stack([moments[somebody], rows["ids"][somebody]])
    found, counts = np.unique(pairs, axis=1, return_counts=True)
    if (counts > 1).any():
        twice = int(found[1, counts > 1][0])
        raise _check.InputError(f"ids: expected each once in a frame, found {twice} twice")


def _require(name: str, expected: str, values: Floats, good: npt.NDArray[np.bool_]) -> None:
    if not good.all():
        raise _check.InputError(f"{name}: expected {expected}, found {values[~good].ravel()[0]:g}")


def _check_joints(rows: Rows) -> None:
    joints = rows["joints"]
    near = ~(np.abs(joints) > _FARTHEST_M)
    _require("joints", f"places within {_FARTHEST_M:g} m", joints, near)
    there = np.isfinite(joints).all(axis=-1)
    for name in ("confidence", "reliability"):
        values = rows[name][there]
        good = np.isnan(values) | ((values >= 0) & (values <= 1))
        _require(name, "0 to 1, or NaN where unknown", values, good)
    turns = rows["orientations"][there]
    lengths = np.linalg.norm(turns, axis=-1)
    good = np.isnan(turns).all(axis=-1) | (np.abs(lengths - 1) <= _OFF_UNIT_LENGTH)
    _require("orientations", "quaternions of length 1, or NaN where unknown", lengths, good)


def _check_floor(rows: Rows) -> None:
    finite = np.isfinite(rows["floor"])
    good = finite.all(axis=1) | np.isnan(rows["floor"]).all(axis=1)
    if not good.all():
        raise _check.InputError("floor: expected four numbers or four NaN a row, found some of each")


def _check_bones(rows: Rows) -> None:
    bones_m = rows["bones_m"]
    known = bones_m[~np.isnan(bones_m).all(axis=1)]
    expected = f"0 to {_LONGEST_BONE_M:g} m of every bone, or NaN of all"
    _require("bones_m", expected, known, (known >= 0) & (known <= _LONGEST_BONE_M))


def check_rows(rows: Rows) -> None:
    """Raises InputError in one line that names the column."""
    _check_times(rows)
    _check_ids(rows)
    _check_joints(rows)
    _check_floor(rows)
    _check_bones(rows)
