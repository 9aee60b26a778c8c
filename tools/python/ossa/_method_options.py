"""Options which Tracker and reconstruct have in common: of single methods, and of the physical character."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Mapping, Optional, TypedDict, TypeVar

from . import _check, _native

_Function = TypeVar("_Function", bound=Callable[..., Any])

_LOCAL_PCA = ("shum-2013", "plantard-2016")
_PROCESSES = ("liu-2016", "full-gp")
_BEST = ("best",)

_MOST = 100000  # of any count

Reader = Callable[[str, Any], Any]


def _count(name: str, value: Any) -> int:
    return _check.whole(name, value, 1, _MOST)


def _two(name: str, value: Any) -> int:
    return _check.whole(name, value, 2, _MOST)


def _weight(name: str, value: Any) -> float:
    return _check.number(name, value, 0.0, 1e6)


def _solver(name: str, value: Any) -> str:
    return str(_check.one_of(name, value, ("stochastic", "ceres")))


class MethodOptions(TypedDict, total=False):
    """Type hints of the options by name; HELP describes them."""

    neighbours: Optional[int]
    dimensions: Optional[int]
    steps: Optional[int]
    samples: Optional[int]
    solver: Optional[str]
    control_weight: Optional[float]
    style: Optional[float]
    kinematics: Optional[float]
    continuity: Optional[float]
    use_reliability: Optional[bool]
    keep_reliable: Optional[bool]
    extend_database: Optional[bool]
    nearby_models: Optional[int]
    incremental: Optional[bool]
    spatial: Optional[float]
    temporal: Optional[float]
    reliability: Optional[float]
    repair: Optional[bool]
    complete: Optional[bool]
    correct: Optional[bool]
    filter: Optional[bool]
    constant_bones: Optional[bool]


# What each option must be, and which methods read it.
_OPTIONS: Mapping[str, tuple[Reader, tuple[str, ...]]] = {
    "neighbours": (_two, _LOCAL_PCA),
    "dimensions": (_count, _LOCAL_PCA),
    "steps": (_count, _LOCAL_PCA),
    "samples": (_count, _LOCAL_PCA),
    "solver": (_solver, _LOCAL_PCA),
    "use_reliability": (_check.flag, _LOCAL_PCA),
    "keep_reliable": (_check.flag, _LOCAL_PCA),
    "extend_database": (_check.flag, ("shum-2013",)),
    "control_weight": (_weight, _LOCAL_PCA),
    "style": (_weight, _LOCAL_PCA),
    "kinematics": (_weight, _LOCAL_PCA),
    "continuity": (_weight, _LOCAL_PCA),
    "nearby_models": (_count, _PROCESSES),
    "incremental": (_check.flag, _PROCESSES),
    "spatial": (_weight, _PROCESSES),
    "temporal": (_weight, _PROCESSES),
    "reliability": (_weight, _PROCESSES),
    "repair": (_check.flag, _BEST),
    "complete": (_check.flag, _BEST),
    "correct": (_check.flag, _BEST),
    "filter": (_check.flag, _BEST),
    "constant_bones": (_check.flag, _BEST),
}

HELP = """neighbours, dimensions, steps, samples : int, optional
        Of shum-2013 and plantard-2016 (Shum 2013, table V): database postures of the local PCA
        (30), its dimensions (20), steps of the search in it (20), samples a step (100).
    solver : "stochastic" or "ceres", optional
        Of shum-2013 and plantard-2016: the papers' search, or Levenberg-Marquardt.
    control_weight, style, kinematics, continuity : float, optional
        Of shum-2013 and plantard-2016: weights of the energy's terms, eq. 15 (1, 0.5, 1.5, 0.25).
    use_reliability, keep_reliable : bool, optional
        Of shum-2013 and plantard-2016: weigh joints by their reliability (True); leave reliable
        joints where they were seen (False; not in the papers).
    extend_database : bool, optional
        Of shum-2013: reliable postures join a private copy of the database (False; sec. IX).
    nearby_models : int, optional
        Of liu-2016 and full-gp: local models used per joint (9; Liu 2016, sec. 4.2.2).
    spatial, temporal, reliability : float, optional
        Of liu-2016 and full-gp: weights of the energy's terms, eq. 22 (0.6, 0.2, 0.2).
    incremental : bool, optional
        Of liu-2016 and full-gp: reliable samples join the local models (True; algorithm 2).
    repair, complete, correct, filter, constant_bones : bool, optional
        Of best, to switch off one of its steps (all True): gross failures are told from motion;
        joints in doubt come from the pose prior; learned systematic errors are corrected; each
        joint is filtered; bones keep their lengths."""


def takes_method_options(function: _Function) -> _Function:
    """For functions that end in **method_options: help() shows each of them."""
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    options = [
        inspect.Parameter(
            name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind.__forward_arg__
        )
        for name, kind in MethodOptions.__annotations__.items()
    ]
    function.__signature__ = signature.replace(parameters=own + options)  # type: ignore[attr-defined]
    return function


def checked(method: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Those options that are not None. One that the method does not read is refused, because it
    would have no effect."""
    chosen = {}
    for name, value in given.items():
        if name not in _OPTIONS:
            raise TypeError(f"got an unexpected keyword argument {name!r}")
        if value is None:
            continue
        read, methods = _OPTIONS[name]
        if method not in methods:
            raise _check.InputError(
                f"{name}: expected a method that reads it ({', '.join(methods)}), found {method!r}"
            )
        chosen[name] = read(name, value)
    return chosen


def check_files(method: str, files: Mapping[str, str]) -> None:
    """Refuses a file that the method does not read, and a method without a file that it needs."""
    if method not in _ROWS:  # butterworth, which reads none
        row: Mapping[str, Any] = {"database": 0, "learned": 0, "prior": False}
    else:
        row = _ROWS[method]
    for name in ("database", "learned", "prior"):
        given = files.get(name, "")
        if given not in ("", "none") and not row[name]:
            raise _check.InputError(
                f"{name}: expected a method that reads it, found method {method!r}"
            )
    if row["learned"] == _NEEDED and files.get("learned", "") in ("", "none"):
        raise _check.InputError(
            f"learned: expected the .ossagp file of ossa.learn, which method {method!r} works by"
        )
    if row["prior"] and files.get("database", "") and files.get("prior", ""):
        raise _check.InputError(
            f"database, prior: expected one of them, method {method!r} completes by one"
        )


def check_keeps_bones(method: str, bones: str) -> None:
    """Refuses the bones of a whole recording for a method that moves joints alone."""
    if bones == "recording" and not (method in _ROWS and _ROWS[method]["keeps_bones"]):
        keeping = ", ".join(name for name, row in _ROWS.items() if row["keeps_bones"])
        raise _check.refuse("bones 'recording'", f"a method that keeps bones ({keeping})", method)


_NEEDED = 2
_ROWS: dict[str, Mapping[str, Any]] = {str(row["name"]): row for row in _native.methods}


def mechanics_option(
    physics: Any, control: Any, hinges: Any, joint_limits: Any, scene: Any = None
) -> dict[str, bool]:
    """Options of the physical character; refused without physics or a scene."""
    _check.flag("physics", physics)
    build = {
        "motors": _check.one_of("control", control, ("pd", "motor")) == "motor",
        "hinges": _check.flag("hinges", hinges),
        "joint_limits": _check.flag("joint_limits", joint_limits),
    }
    if any(build.values()) and not physics and scene is None:
        raise _check.InputError(
            "control, hinges, joint_limits: expected physics=True or a scene with them"
        )
    return build
