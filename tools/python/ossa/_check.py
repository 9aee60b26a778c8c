"""Checks of arguments: each function returns its value as the extension accepts it, or raises
InputError with one line that names the argument, what was expected and what was found."""

from __future__ import annotations

import math
import os
import re
from typing import Any, Iterable, Sequence

import numpy as np

from ._native import InputError as InputError

InputError.__doc__ = """An invalid argument, file or device. A ValueError whose message is one line that names it,
what was expected and what was found."""

_LONGEST = 60  # characters of a value that a message quotes


def found(value: object) -> str:
    """A value for messages: short, on one line, without calling its __repr__."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {list(value.shape)}"
    if value is None or type(value) in (str, bool, int, float):
        text = ascii(value)
        return text if len(text) <= _LONGEST else text[:_LONGEST] + "..."
    return type(value).__name__


def refuse(name: str, expected: str, value: object) -> InputError:
    """The error to raise."""
    return InputError(f"{name}: expected {expected}, found {found(value)}")


def of_python(error: InputError) -> InputError:
    """The error about an option of the command, with the argument's name."""
    return InputError(re.sub(r"^--([a-z-]+):", lambda m: m[1].replace("-", "_") + ":", str(error)))


def number(name: str, value: Any, least: float, most: float) -> float:
    """A finite number from `least` to `most`."""
    expected = f"a number from {least:g} to {most:g}"
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.number)):
        raise refuse(name, expected, value)
    try:
        real = float(value)
    except (OverflowError, TypeError):
        raise refuse(name, expected, value) from None
    if not (math.isfinite(real) and least <= real <= most):
        raise refuse(name, expected, real)
    return real


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number from `least` to `most`."""
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not is_whole or not least <= int(value) <= most:
        raise refuse(name, f"a whole number from {least} to {most}", value)
    return int(value)


def frame_s(value: Any) -> float:
    """Seconds from frame to frame, or 0 for None: the usual ones of a format."""
    return 0.0 if value is None else number("frame_s", value, 1e-6, 1e3)


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise refuse(name, "True or False", value)
    return bool(value)


def function(name: str, value: Any) -> Any:
    """A callable."""
    if not callable(value):
        raise refuse(name, "a function", value)
    return value


def one_of(name: str, value: Any, allowed: Iterable[Any]) -> Any:
    """One of a few words or numbers."""
    values = list(allowed)
    if isinstance(value, (str, int)) and not isinstance(value, bool) and value in values:
        return value
    raise refuse(name, "one of " + ", ".join(str(v) for v in values), value)


def text(name: str, value: Any) -> str:
    """A str that can be written as UTF-8."""
    if isinstance(value, str):
        try:
            value.encode()
            return str(value)
        except UnicodeEncodeError:
            pass
    raise refuse(name, "a text", value)


def texts(name: str, value: Any) -> list[str]:
    """One text or several."""
    if isinstance(value, str):
        return [text(name, value)]
    if not isinstance(value, (list, tuple)):
        raise refuse(name, "a text or a list of texts", value)
    return [text(name, v) for v in value]


def path(name: str, value: Any) -> str:
    """A path, not empty: str or os.PathLike."""
    if isinstance(value, (str, os.PathLike)):
        written = os.fspath(value)
        if isinstance(written, str) and written and "\0" not in written:
            return text(name, written)
    raise refuse(name, "a path", value)


def optional_path(name: str, value: Any) -> str:
    """A path, or "" for None."""
    return "" if value is None else path(name, value)


def plain(name: str, expected: str, value: Any) -> Any:
    """A NumPy array, not copied, also one mapped from a file. Masked arrays are refused, because the
    mask would be lost."""
    if not isinstance(value, np.ndarray):
        raise refuse(name, f"a NumPy array, {expected}", value)
    if isinstance(value, np.ma.MaskedArray):
        raise InputError(f"{name}: expected a NumPy array without a mask, found a masked one")
    return np.asarray(value)


def image(depth_mm: Any) -> Any:
    """A NumPy array; the extension checks the rest of it."""
    return plain("depth_mm", "uint16 [height, width]", depth_mm)


def array(name: str, value: Any, shape: Sequence[int | None], dtype: Any) -> Any:
    """An array of this shape (None: any length) and type, converted from any array-like. Values are
    never rounded, wrapped or taken from under a mask."""
    sides = ", ".join("any" if side is None else str(side) for side in shape)
    expected = f"{np.dtype(dtype).name} [{sides}]"
    if isinstance(value, np.ma.MaskedArray) and np.any(value.mask):
        raise InputError(f"{name}: expected {expected} without a mask, found a masked array")
    try:
        given = np.asarray(value)
        with np.errstate(invalid="ignore"):  # of NaN as a whole number, which is refused below
            made = np.array(given.real if given.dtype.kind == "c" else given, dtype=dtype)
    except (TypeError, ValueError, OverflowError):
        raise refuse(name, expected, value) from None
    fits = made.ndim == len(shape) and all(s in (None, n) for s, n in zip(shape, made.shape))
    if not fits or given.dtype.kind == "c":
        raise refuse(name, expected, given)
    if np.issubdtype(made.dtype, np.integer) and given.dtype.kind in "iuf":
        changed = made != given
        if changed.any():
            raise InputError(f"{name}: expected {expected}, found {given[changed].ravel()[0]!r}")
    return made
