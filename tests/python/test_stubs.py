"""The type stubs name what the module has, and the documents' code runs."""

import ast
import inspect
import json
import re
import subprocess
import sys

import pytest

import drape
import drape._core
from conftest import SOURCE


def stub():
    return ast.parse((SOURCE / "core/app/python/drape/_core.pyi").read_text())


def names_in(nodes):
    names = set()
    for node in nodes:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    return names


def public(names):
    return {n for n in names if not n.startswith("__") or n in ("__version__", "__commit__")}


def test_the_stubs_name_every_function_and_class():
    assert public(names_in(stub().body)) == public(vars(drape._core))


def test_stubtest_finds_the_same_members_and_signatures(tmp_path):
    # Classes of pybind11 have a metaclass and an __init__ of their own that no stub can name.
    allowed = tmp_path / "allowed"
    allowed.write_text("drape\\._core\\.[A-Z]\\w*\ndrape\\._core\\.[A-Z]\\w*\\.__init__\n")
    ended = subprocess.run([sys.executable, "-m", "mypy.stubtest", "drape._core", "--allowlist", allowed,
                            "--ignore-unused-allowlist"], cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_mypy_accepts_the_package_and_its_use(tmp_path):
    ended = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", tmp_path], cwd=SOURCE, capture_output=True,
                           text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_everything_public_has_a_docstring():
    for name in drape.__all__:
        thing = getattr(drape, name)
        if inspect.isclass(thing) or inspect.isroutine(thing):
            assert inspect.getdoc(thing), name


def blocks_of(page):
    text = (SOURCE / page).read_text()
    return re.findall(r"```python\n(.*?)```", text, re.S)


@pytest.mark.parametrize("page", ["docs/guide/python.md", "docs/extend/from-python.md"])
def test_the_code_of_a_page_runs(page, monkeypatch, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.setattr("webbrowser.open", lambda url: None)
    monkeypatch.chdir(SOURCE)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    code = blocks_of(page)
    assert code
    exec(compile("\n".join(code), page, "exec"), {"__name__": "page"})


@pytest.mark.parametrize("notebook", sorted((SOURCE / "docs/guide/notebooks").glob("*.ipynb")),
                         ids=lambda path: path.stem)
def test_a_notebook_runs(notebook, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(SOURCE)
    cells = json.loads(notebook.read_text())["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert len(code) >= 3
    names = {"__name__": "notebook"}
    for number, cell in enumerate(code):
        exec(compile(cell, f"{notebook.name}, code cell {number + 1}", "exec"), names)
