"""ossa.compare, ossa.evaluate, ossa.learn: errors of skeletons and forests, and their correction."""

from __future__ import annotations

import json
import logging
import os
import tempfile
from typing import Any, Optional, Sequence as Several, Union

from . import _check, _native
from ._names import SKELETON_FORMATS
from ._sequences import Sequence
from ._skeleton_files import write_skeletons
from ._sources import PathLike

_LOG = logging.getLogger("ossa")

Skeletons = Union[PathLike, Sequence]


class Comparison(dict[str, Any]):
    """The object of `ossa compare --json`: ["results"] is a list of dicts, one for each result."""

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row for each result: its measures, those of joints as
        "per_joint_cm.Head". Raises ImportError without pandas."""
        from ._tables import pandas

        kept = [{k: v for k, v in r.items() if not isinstance(v, list)} for r in self["results"]]
        return pandas().json_normalize(kept)


class _Files:
    """Skeletons as files: sequences in memory are written to a temporary folder."""

    def __enter__(self) -> _Files:
        self._folder = tempfile.TemporaryDirectory(prefix="ossa")
        self._names: dict[str, str] = {}
        return self

    def __exit__(self, *_: Any) -> None:
        self._folder.cleanup()

    def path_of(self, name: str, skeletons: Any) -> str:
        if not isinstance(skeletons, Sequence):
            return _check.path(name, skeletons)
        path = os.path.join(self._folder.name, f"{len(self._names)}.jsonl")
        write_skeletons(skeletons, path)
        self._names[path] = name
        return path

    def named(self, text: str) -> str:
        """The text with the paths of temporary files replaced by the names of the arguments."""
        for path, name in self._names.items():
            text = text.replace(json.dumps(path)[1:-1], name).replace(path, name)
        return text


def _clock_options(time: Union[str, float], max_offset_s: float) -> dict[str, Any]:
    return {
        "time": _check.one_of("time", time, ("auto", "none", "correlate"))
        if isinstance(time, str)
        else _check.number("time", time, -1e9, 1e9),
        "max_offset_s": _check.number("max_offset_s", max_offset_s, 0.0, 60.0),
    }


def _several(name: str, value: Any) -> list[Any]:
    several = list(value) if isinstance(value, (list, tuple)) else [value]
    if not several:
        raise _check.refuse(name, "at least one", value)
    return several


def compare(
    truth: Skeletons,
    result: Union[Skeletons, Several[Skeletons]],
    *,
    align: str = "none",
    joints: str = "all",
    time: Union[str, float] = "auto",
    max_offset_s: float = 2.0,
    format: Optional[str] = None,
    mapping: Optional[PathLike] = None,
    frame_s: Optional[float] = None,
    only: Union[str, Several[str]] = (),
    skip: Union[str, Several[str]] = (),
    seed: int = 1,
) -> Comparison:
    """Compares skeletons with the truth, or with each other, as `ossa compare` does.

    Parameters
    ----------
    truth : path or Sequence
        The skeletons to compare with: a file, a folder, an archive, or one in memory.
    result : path or Sequence, or a list of such
        The skeletons to evaluate. Clips of folders and archives are matched by name.
    align : "none" or "rigid"
        rigid: one rotation and translation per clip (Procrustes).
    joints : "all" or "found"
        Joints of a result: all that have a position, or without those not_tracked.
    time : "auto", "none", "correlate" or float
        auto: cross-correlation where the frame times disagree; or seconds to add to the results'
        times.
    max_offset_s : float
        Largest offset tried by the correlation, seconds, 0 to 60.
    format : str, optional
        Read every file in this format, one of ossa.SKELETON_FORMATS.
    mapping, frame_s : optional
        As of read_skeletons.
    only, skip : str or list of str
        Only clips, or no clips, whose name contains one of these.
    seed : int
        Of the bootstrap.

    Returns
    -------
    dict
        The fields of `ossa compare --json`: {"results": [{"name", "frames", "mean_joint_error_cm",
        "parent_relative_error_cm", "fraction_frames_over_20cm", "fraction_joints_within_10cm",
        "acceleration_error_cm_per_frame2", "per_joint_cm": {joint: x}, ...}], ...}; with
        .to_pandas().
    """
    options = {
        "align": _check.one_of("align", align, ("none", "rigid")),
        "joints": _check.one_of("joints", joints, ("all", "found")),
        **_clock_options(time, max_offset_s),
        "format": "" if format is None else _check.one_of("format", format, SKELETON_FORMATS),
        "mapping": _check.optional_path("mapping", mapping),
        "frame_s": _check.frame_s(frame_s),
        "only": _check.texts("only", only),
        "skip": _check.texts("skip", skip),
        "seed": _check.whole("seed", seed, 0, 2**63 - 1),
    }
    with _Files() as files:
        results = _several("result", result)
        names = [f"result {i}" if len(results) > 1 else "result" for i in range(len(results))]
        truth_path = files.path_of("truth", truth)
        paths = [files.path_of(name, r) for name, r in zip(names, results)]
        try:
            text, warnings = _native.compare(truth_path, paths, options)
        except _native.InputError as error:
            raise _native.InputError(files.named(str(error))) from None
        for warning in warnings:
            _LOG.warning("%s", files.named(warning))
        return Comparison(json.loads(files.named(text)))


def evaluate(model: PathLike, dataset: PathLike, every: int = 1) -> dict[str, Any]:
    """Measures a forest on a labelled data set that it was not trained on, as `ossa evaluate`.

    Parameters
    ----------
    model : path
        .ossa of `ossa train`.
    dataset : path
        A folder made by `ossa render`.
    every : int
        Evaluate every N-th frame, 1 or more.

    Returns
    -------
    dict
        The fields of `ossa evaluate --json`: {"frames", "pixel_accuracy", "mean_class_accuracy",
        "per_class_accuracy": {part: x}, "map_10cm", "ap_10cm": {joint: x}, "ns_per_pixel",
        "classify_ms", "propose_ms", ...}; None where the data have no value.
    """
    step = _check.whole("every", every, 1, 2**31 - 1)
    text = _native.evaluate(_check.path("model", model), _check.path("dataset", dataset), step)
    return dict(json.loads(text))


def learn(
    observed: Union[Skeletons, Several[Skeletons]],
    truth: Union[Skeletons, Several[Skeletons]],
    out: PathLike,
    *,
    correction_only: bool = False,
    regions: int = 30,
    samples: int = 50,
    pairs: int = 2500,
    time: Union[str, float] = "none",
    max_offset_s: float = 2.0,
    mapping: Optional[PathLike] = None,
    frame_s: Optional[float] = None,
    seed: int = 1,
) -> dict[str, Any]:
    """Learns a sensor's errors from pairs of observed and true skeletons, as `ossa learn` does.

    Parameters
    ----------
    observed : path or Sequence, or a list of such
        Skeletons of the sensor: files, folders, archives, or sequences in memory.
    truth : path or Sequence, or a list of such
        True skeletons, in the same order; joints may be missing.
    out : path
        The .ossagp file to write, for Tracker(learned=...) and reconstruct(learned=...).
    correction_only : bool
        Only the correction for best: fast to learn, a quarter of a megabyte.
    regions, samples : int
        Q and S of liu-2016, 1 to 1000 and 2 to 5000.
    pairs : int
        Pairs at most, for liu-2016, full-gp and exemplar; 10 or more.
    time, max_offset_s
        As of ossa.compare: how the observed times are shifted to the clock of the truth. The logger
        "ossa" reports offsets that were found.
    mapping, frame_s : optional
        As of read_skeletons.
    seed : int
        Of the clustering.

    Returns
    -------
    dict
        {"out": path, "pairs": how many frames were learned from}.
    """
    options = {
        "correction_only": _check.flag("correction_only", correction_only),
        "regions": _check.whole("regions", regions, 1, 1000),
        "samples": _check.whole("samples", samples, 2, 5000),
        "pairs": _check.whole("pairs", pairs, 10, 2**31 - 1),
        **_clock_options(time, max_offset_s),
        "mapping": _check.optional_path("mapping", mapping),
        "frame_s": _check.frame_s(frame_s),
        "seed": _check.whole("seed", seed, 0, 2**63 - 1),
    }
    written = _check.path("out", out)
    if not written.lower().endswith(".ossagp"):
        raise _check.refuse("out", "a name that ends in .ossagp", written)
    with _Files() as files:
        seen = [files.path_of("observed", s) for s in _several("observed", observed)]
        known = [files.path_of("truth", s) for s in _several("truth", truth)]
        try:
            count, warnings, notes = _native.learn(seen, known, written, options)
        except _native.InputError as error:
            raise _native.InputError(files.named(str(error))) from None
        for warning in warnings:
            _LOG.warning("%s", files.named(warning))
        for note in notes:
            _LOG.info("%s", files.named(note))
    return {"out": written, "pairs": count}
