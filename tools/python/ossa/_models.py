"""ossa.Models: the models of trackers in memory."""

from __future__ import annotations

import logging
from typing import Any, Optional

from . import _check, _method_options, _native
from ._names import METHODS
from ._sources import PathLike

_LOG = logging.getLogger("ossa")


class Models:
    """The models of a tracker in memory: read once, shared by any number of trackers, also in several
    threads at the same time.

    Parameters
    ----------
    method : str
        The method of the trackers, which decides which files are read; one of ossa.METHODS.
    model : path, optional
        Forest, .ossa of `ossa train`. Left out: the shipped one.
    refinement : path or "none", optional
        Cascaded refinement, .ossarefine of `ossa refine`. Left out: the shipped one if it belongs to
        forest and method.
    learned : path or "none", optional
        .ossagp of ossa.learn, for learned methods. Left out: with best and the shipped forest the
        shipped one.
    prior : path or "none", optional
        .ossaprior of `ossa prior`, for best. Left out: the shipped one.
    database : path or "none", optional
        .ossadb of `ossa database`. Left out: the shipped one, for methods that need one.
    pose_network : path or "none", optional
        .ossanet of tools/train_pose_network. Left out: the shipped one beside the shipped
        refinement.
    surface : path or "none", optional
        .ossasurface of `ossa surface`, the body that is fitted. Left out: the shipped one. "none":
        no fit.
    mesh : path, optional
        .ossamesh of `ossa surface`, the mesh of that surface: required with your own surface.
    """

    def __init__(
        self,
        method: str = "best",
        model: Optional[PathLike] = None,
        refinement: Optional[PathLike] = None,
        learned: Optional[PathLike] = None,
        prior: Optional[PathLike] = None,
        database: Optional[PathLike] = None,
        pose_network: Optional[PathLike] = None,
        surface: Optional[PathLike] = None,
        mesh: Optional[PathLike] = None,
    ) -> None:
        _check.one_of("method", method, METHODS)
        files = {
            "forest": _check.optional_path("model", model),
            "refinement": _check.optional_path("refinement", refinement),
            "learned": _check.optional_path("learned", learned),
            "prior": _check.optional_path("prior", prior),
            "database": _check.optional_path("database", database),
            "pose_network": _check.optional_path("pose_network", pose_network),
            "surface": _check.optional_path("surface", surface),
            "mesh": _check.optional_path("mesh", mesh),
        }
        if files["surface"] not in ("", "none") and not files["mesh"]:
            raise _check.InputError(f"surface: expected its skin with it, mesh, found {files['surface']} alone")
        _method_options.check_files(method, files)
        self._native = _native.Models(files, method)
        for warning in self._native.warnings:
            _LOG.warning("%s", warning)

    @property
    def method(self) -> str:
        """The method that these were read for."""
        return self._native.method


def models_for(method: str, given: Any, files: dict[str, Any]) -> Models:
    """The given models, or those of the files; refuses models of another method, or both."""
    if given is None:
        return Models(method, **files)
    if not isinstance(given, Models):
        raise _check.refuse("models", "an ossa.Models", given)
    if given.method != method:
        raise _check.refuse("models", f"those of method {method!r}", given.method)
    named = [name for name, file in files.items() if file is not None]
    if named:
        raise _check.InputError(f"models, {named[0]}: expected one of them, found both")
    return given
