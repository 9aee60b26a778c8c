"""Files of skeletons: ossa.read_skeletons, ossa.read_recordings, ossa.write_skeletons."""

from __future__ import annotations

import os
from typing import Any, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _native
from ._names import SKELETON_FORMATS
from ._sequences import Sequence, from_native, to_rows
from ._sources import PathLike


def _reading(format: Any, columns: Any, mapping: Any, frame_s: Any) -> dict[str, Any]:
    return {
        "format": "" if format is None else _check.one_of("format", format, SKELETON_FORMATS),
        "columns": ""
        if columns is None
        else _check.one_of("columns", columns, ("truth", "observed")),
        "mapping": _check.optional_path("mapping", mapping),
        "frame_s": _check.frame_s(frame_s),
    }


def read_skeletons(
    path: PathLike,
    format: Optional[str] = None,
    columns: Optional[str] = None,
    mapping: Optional[PathLike] = None,
    frame_s: Optional[float] = None,
) -> Sequence:
    """Reads one recording of skeletons: ossa's own, an SDK's, or motion capture, recognised by content.

    Parameters
    ----------
    path : path
        A file, "FILE#truth" or "FILE#observed" of a file that holds both, or "FOLDER#NAME" and
        "ARCHIVE#NAME" of one recording among several.
    format : str, optional
        One of ossa.SKELETON_FORMATS, if the content is ambiguous.
    columns : "truth" or "observed", optional
        Which skeleton of files that contain two side by side.
    mapping : path, optional
        Mapping file for unknown joint names (docs/files.md).
    frame_s : float, optional
        Seconds from frame to frame, for formats without times.

    Returns
    -------
    Sequence
        In camera space and metres, whatever the file's axes and units.
    """
    options = _reading(format, columns, mapping, frame_s)
    return from_native(_native.read_skeletons(_check.path("path", path), options))


def read_recordings(
    path: PathLike,
    format: Optional[str] = None,
    columns: Optional[str] = None,
    mapping: Optional[PathLike] = None,
    frame_s: Optional[float] = None,
) -> dict[str, Sequence]:
    """All recordings of a folder (recursively), an archive (.tar .tar.gz .zip) or a file.

    Parameters
    ----------
    path, format, columns, mapping, frame_s
        As of read_skeletons.

    Returns
    -------
    dict of str to Sequence
        By path inside the folder or archive; "" of a single file.
    """
    options = _reading(format, columns, mapping, frame_s)
    clips = _native.read_clips(_check.path("path", path), options)
    return {name: from_native(made) for name, made in clips}


def write_skeletons(
    sequence: Sequence,
    path: PathLike,
    names: Optional[str] = None,
    *,
    surface: Optional[PathLike] = None,
    mesh: Optional[PathLike] = None,
    shapes: Optional[Mapping[int, npt.ArrayLike]] = None,
) -> None:
    """Writes skeletons in the format that the extension names: .jsonl, .csv, .trc, .bvh or .glb.

    TRC and BVH contain one person per file: the first goes to `path`, each other to `path` with _ID
    before the extension. A .glb (glTF 2.0) shows everybody's body in motion. The file appears under
    its name only when complete.

    Parameters
    ----------
    sequence : Sequence
        The skeletons to write.
    path : path
        The output file.
    names : "sdk", "cmu", "mixamo" or "vrm", optional
        Naming scheme of the bones of a .bvh or .glb. Left out: "sdk" for a .bvh, "vrm" for a .glb.
    surface, mesh : path, optional
        Of a .glb: the mesh of people, .ossasurface and .ossamesh of `ossa surface`; mesh "none": bones
        only. Left out: the shipped ones.
    shapes : dict of int to float64 [10], optional
        Of a .glb: body shapes, Fit.shape by Body.id, of the same surface. Left out: the mean shape,
        stretched to the bone lengths.
    """
    to = _check.path("path", path)
    kind = os.path.splitext(to)[1].lower()
    if names is not None:
        _check.one_of("names", names, ("sdk", "cmu", "mixamo", "vrm"))
        if kind not in (".bvh", ".glb") or (names == "sdk" and kind == ".glb"):
            expected = "a .bvh, or a .glb and names other than sdk"
            raise _check.refuse(f"names {names!r}", expected, to)
    how = {
        "names": names or "",
        "surface": _check.optional_path("surface", surface),
        "mesh": _check.optional_path("mesh", mesh),
    }
    if shapes is not None and kind != ".glb":
        raise _check.refuse("shapes", "a .glb", to)
    _native.write_skeletons(to_rows(sequence), to, how, _shapes_option(shapes))


def _shapes_option(shapes: Optional[Mapping[int, npt.ArrayLike]]) -> dict[int, list[float]]:
    if shapes is None:
        return {}
    if not isinstance(shapes, Mapping):
        raise _check.refuse("shapes", "a dict of float64 [10] by body id", shapes)
    made = {}
    for body, values in shapes.items():
        shape = _check.array("shapes", values, (10,), float)
        if not np.isfinite(shape).all():
            raise _check.refuse("shapes", "finite numbers", shape)
        made[_check.whole("shapes: id", body, 0, 2**31 - 1)] = shape.tolist()
    return made
