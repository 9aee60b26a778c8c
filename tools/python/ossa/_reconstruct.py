"""ossa.reconstruct: methods that make recorded skeletons complete and plausible."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _check, _method_options, _native
from ._names import METHODS
from ._sequences import Sequence, from_native, to_rows
from ._sources import PathLike

if TYPE_CHECKING:
    from typing_extensions import Unpack


_LOG = logging.getLogger("ossa")


def _lag_option(lag: Any) -> Optional[int]:
    if lag is None:
        return None
    if isinstance(lag, str):
        _check.one_of("lag", lag, ("whole",))
        return -1
    return _check.whole("lag", lag, 0, 2)


@_method_options.takes_method_options
def reconstruct(
    sequence: Sequence,
    method: str = "best",
    *,
    database: Optional[PathLike] = None,
    prior: Optional[PathLike] = None,
    learned: Optional[PathLike] = None,
    bones: str = "so-far",
    physics: bool = False,
    control: str = "pd",
    hinges: bool = False,
    joint_limits: bool = False,
    cutoff_hz: Optional[float] = None,
    lag: Union[int, str, None] = None,
    seed: int = 1,
    **method_options: Unpack[_method_options.MethodOptions],
) -> Sequence:
    """Makes recorded skeletons complete and plausible, as `ossa reconstruct` does.

    Parameters
    ----------
    sequence : Sequence
        Observed skeletons. Absent joints and those not tracked are reconstructed. The logger "ossa"
        warns of times and lengths that cannot be seconds and metres.
    method : str
        One of ossa.METHODS, or "butterworth": a low pass over the whole recording, for comparison.
    database : path, optional
        .ossadb of `ossa database`. Left out: the shipped one; of best the shipped prior.
    prior : path, optional
        .ossaprior of `ossa prior`, for best. Left out: the shipped one.
    learned : path or "none", optional
        .ossagp of ossa.learn, which liu-2016, full-gp and exemplar need. Left out: best corrects
        the known errors of the sequence's sensor.
    bones : "so-far" or "recording"
        Bone lengths by the frames so far, or by all frames (constant over the recording). For methods
        that keep bones.
    physics : bool
        Let a physical character follow the result (Shum 2013, sec. VII).
    control : "pd" or "motor"
        With physics: the controller of the character.
    hinges, joint_limits : bool
        With physics: elbows and knees bend about one axis; joints have human ranges.
    cutoff_hz : float, optional
        Cut-off frequency of butterworth, Hz (6).
    lag : int or "whole", optional
        Number of later frames used for smoothing, 0 to 2, or "whole": frames before and after. Left
        out: "whole" with best, else 0.
    seed : int
        For methods that draw samples.
    METHOD_OPTIONS

    Returns
    -------
    Sequence
        All 20 joints in every row with a body, each with its reliability; tracked joints stay
        "tracked", reconstructed ones are "inferred".

    Raises
    ------
    ossa.InputError
        Naming the argument, or the file that is missing or damaged.
    """
    given = dict(locals())
    _check.one_of("method", method, METHODS + ("butterworth",))
    _check.one_of("bones", bones, ("so-far", "recording"))
    files = {name: _check.optional_path(name, given[name]) for name in ("database", "prior", "learned")}
    _method_options.check_files(method, files)
    _method_options.check_keeps_bones(method, bones)
    if cutoff_hz is not None and method != "butterworth":
        raise _check.refuse("cutoff_hz", "method 'butterworth', which reads it", method)
    options = {
        "method": method,
        "files": files,
        "bones": bones,
        "physics": _check.flag("physics", physics),
        "mechanics": _method_options.mechanics_option(physics, control, hinges, joint_limits),
        "cutoff_hz": 6.0 if cutoff_hz is None else _check.number("cutoff_hz", cutoff_hz, 1e-3, 1e3),
        "lag": _lag_option(lag),
        "seed": _check.whole("seed", seed, 0, 2**63 - 1),
        "method_options": _method_options.checked(method, method_options),
    }
    rows = to_rows(sequence)
    if not sequence.source:  # of files the reader logged them
        for oddity in _native.describe_oddities(rows):
            _LOG.warning("sequence: %s", oddity)
    return from_native(_native.reconstruct(rows, options))


reconstruct.__doc__ = (reconstruct.__doc__ or "").replace("METHOD_OPTIONS", _method_options.HELP)
