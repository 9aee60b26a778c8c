"""Tables for pandas, which is imported only here, on demand."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from ._names import JOINTS


def pandas() -> Any:
    """The module."""
    try:
        return importlib.import_module("pandas")
    except ImportError:
        raise ImportError("to_pandas: needs the package pandas: pip install pandas") from None


def table_of_joints(
    frames: Any, times: Any, ids: Any, joints: Any, states: Any, confidence: Any, reliability: Any
) -> Any:
    """A row for each joint of each body; the arguments have a row for each body."""
    count, each = len(ids), len(JOINTS)
    places = np.asarray(joints, dtype=np.float64).reshape(count * each, 3)
    return pandas().DataFrame(
        {
            "frame": np.repeat(np.asarray(frames, dtype=np.int64), each),
            "time_s": np.repeat(np.asarray(times, dtype=np.float64), each),
            "id": np.repeat(np.asarray(ids, dtype=np.int64), each),
            "joint": list(JOINTS) * count,
            "x": places[:, 0],
            "y": places[:, 1],
            "z": places[:, 2],
            "state": np.asarray(states).reshape(-1),
            "confidence": np.asarray(confidence, dtype=np.float64).reshape(-1),
            "reliability": np.asarray(reliability, dtype=np.float64).reshape(-1),
        }
    )
