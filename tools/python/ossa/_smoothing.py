"""Filters of joints: ossa.Holt, ossa.OneEuro."""

from __future__ import annotations

import dataclasses
from typing import Any, Union

from . import _check
from ._names import SMOOTHINGS


@dataclasses.dataclass(frozen=True)
class Holt:
    """The Kinect SDK's filter of joints (NUI_TRANSFORM_SMOOTH_PARAMETERS) with your own parameters.

    Parameters
    ----------
    smoothing : float
        Weight in [0, 1); 0: no smoothing.
    correction : float
        Weight in [0, 1]: how fast the filter follows.
    prediction : float
        Frames to predict into the future, 0 or more.
    jitter_radius_m, max_deviation_radius_m : float
        Metres, above 0: movements below the first are damped further; no filtered joint is farther
        from the unfiltered one than the second.
    """

    smoothing: float = 0.5
    correction: float = 0.5
    prediction: float = 0.5
    jitter_radius_m: float = 0.05
    max_deviation_radius_m: float = 0.04


@dataclasses.dataclass(frozen=True)
class OneEuro:
    """The 1 Euro filter of joints (Casiez 2012) with your own parameters.

    Parameters
    ----------
    min_cutoff_hz : float
        Hz, above 0: cut-off frequency for a joint at rest.
    beta_per_m : float
        Increase of the cut-off frequency with speed, Hz per m/s, 0 or more.
    """

    min_cutoff_hz: float = 1.5
    beta_per_m: float = 4.0


Smoothing = Union[str, Holt, OneEuro, None]


def smoothing_option(smoothing: Any) -> Any:
    """The option as the extension takes it: a name, the parameters of Holt or OneEuro, or None."""
    if smoothing is None:
        return None
    if isinstance(smoothing, (Holt, OneEuro)):
        name = type(smoothing).__name__
        values = dataclasses.asdict(smoothing)
        return {k: _check.number(f"{name}: {k}", v, 0.0, 1e6) for k, v in values.items()}
    if isinstance(smoothing, str):
        return _check.one_of("smoothing", smoothing, SMOOTHINGS)
    expected = f"one of {', '.join(SMOOTHINGS)}, an ossa.Holt or an ossa.OneEuro"
    raise _check.refuse("smoothing", expected, smoothing)
