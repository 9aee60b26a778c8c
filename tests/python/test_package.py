"""The package as a whole: types, help, names."""

import inspect
import os
import pathlib
import pydoc
import re
import subprocess
import sys

import pytest

import ossa

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / "tools/python"


def mypy(folder, *arguments):
    pytest.importorskip("mypy")
    where = str(pathlib.Path(ossa.__file__).parents[1])
    environment = {**os.environ, "MYPY_CACHE_DIR": os.devnull, "MYPYPATH": where}
    done = subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True, text=True, cwd=folder, env=environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_pass_mypy_strict():
    mypy(PACKAGE, "mypy", "--config-file", "pyproject.toml", "ossa")


def test_stub_matches_the_extension(tmp_path):
    # Classes of a pybind11 extension have its metaclass, which a stub does not declare.
    (tmp_path / "allowed").write_text(r"ossa\._native\.(Forest|Models|Skin|Source|Tracker|Skin\.__init__)")
    mypy(tmp_path, "mypy.stubtest", "ossa._native", "--allowlist", "allowed")


def test_version_equals_that_of_the_command(command):
    assert ossa.__version__ in command("--version")


def test_reference_page_names_every_public_name():
    page = (PACKAGE.parents[1] / "docs/python.md").read_text()
    for name in ossa.__all__:
        assert re.search(rf"\b{name}\b", page), name


PUBLIC = [name for name in ossa.__all__ if callable(getattr(ossa, name))]
ARRAYS = {"depth_mm", "joints", "points_m", "users"}


@pytest.mark.parametrize("name", PUBLIC)
def test_help_describes_every_public_name(name):
    text = pydoc.render_doc(getattr(ossa, name), renderer=pydoc.plaintext)
    assert inspect.getdoc(getattr(ossa, name)), name
    assert "METHOD_OPTIONS" not in text


def functions():
    """Every public function and method, with the docstring that has its parameters."""
    for name in PUBLIC:
        value = getattr(ossa, name)
        if name in ("InputError", "Joint", "Comparison", "DepthImage", "Source", "Body", "Frame",
                    "Proposals"):  # fmt: skip
            continue  # made by ossa
        yield name, value, value.__doc__
        if not inspect.isclass(value):
            continue
        for method, function in vars(value).items():
            function = getattr(function, "__func__", function)
            if not method.startswith("_") and inspect.isfunction(function):
                yield f"{name}.{method}", function, function.__doc__


@pytest.mark.parametrize("name, function, text", functions())
def test_help_describes_every_argument(name, function, text):
    for argument in inspect.signature(function).parameters:
        if argument.startswith("_") or argument == "self":
            continue
        in_its_list = rf"^ *(\w+, )*{argument}(, \w+)*( :|$)"
        assert re.search(in_its_list, text, re.MULTILINE), (name, argument)


@pytest.mark.parametrize("name, function, text", functions())
def test_help_states_the_shape_of_arrays(name, function, text):
    for argument in set(inspect.signature(function).parameters) & ARRAYS:
        line = re.search(rf"^ *(?:\w+, )*{argument}(?:, \w+)*( : .*)?$", text, re.MULTILINE)
        assert line, (name, argument)
        assert "[" in line.group(0) or "As of" in text, (name, argument)
