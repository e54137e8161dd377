"""The documents' code runs, and the package has types and docstrings."""

import inspect
import json
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import drape
from conftest import SOURCE
from notebooks import NOTEBOOKS

PACKAGE = pathlib.Path(drape.__file__).parent


@pytest.mark.skipif(not (PACKAGE / "_core.pyi").exists(), reason="the module is built without stubgen")
def test_mypy_accepts_the_package_and_its_use(tmp_path):
    ended = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", tmp_path, PACKAGE, "tests/python/prototypes.py"],
                           cwd=SOURCE, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_an_import_error_names_the_python_that_is_meant(tmp_path):
    shutil.copytree(PACKAGE, tmp_path / "drape", ignore=shutil.ignore_patterns("*.so"))
    (tmp_path / "drape/_core.cpython-27-other.so").touch()
    for options, missing in (([], "drape._core"), (["-S"], "numpy")):  # -S: without Debian's packages
        ended = subprocess.run([sys.executable, *options, "-c", "import drape"], cwd=tmp_path, capture_output=True, text=True,
                               env={"PYTHONPATH": str(tmp_path)})
        assert ended.returncode == 1
        for part in (missing, sys.executable, "/usr/bin/python3", "_core.cpython-27-other.so"):
            assert part in ended.stderr.splitlines()[-1]


def test_everything_public_has_a_docstring():
    for name in drape.__all__:
        thing = getattr(drape, name)
        if inspect.isclass(thing) or inspect.isroutine(thing):
            assert inspect.getdoc(thing), name


@pytest.fixture
def at_source(monkeypatch):
    """For code that is run where the sources are, and draws into no window."""
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(SOURCE)


@pytest.mark.parametrize("page", ["README.md", "docs/guide/python.md", "docs/extend/from-python.md"])
def test_the_code_of_a_page_runs(page, at_source, monkeypatch, tmp_path):
    monkeypatch.setattr("webbrowser.open", lambda url: None)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    code = re.findall(r"```python\n(.*?)```", (SOURCE / page).read_text(), re.S)
    assert code
    exec(compile("\n".join(code), page, "exec"), {"__name__": "page"})


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_has_its_outputs(notebook, at_source, capsys):
    def words(text):
        return re.findall(r"[^\W\d]{2,}", text)

    text = notebook.read_text()
    assert len(text) < 300_000
    for place in (str(SOURCE), str(pathlib.Path.home()), "/tmp/", "site-packages", "text/html"):
        assert place not in text
    code = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert len(code) >= 3
    assert any("image/png" in output.get("data", {}) for cell in code for output in cell["outputs"])
    names = {"__name__": "notebook"}
    for number, cell in enumerate(code, 1):
        assert cell["execution_count"] == number, "`make notebooks` stores the outputs"
        exec(compile("".join(cell["source"]), f"{notebook.name}, code cell {number}", "exec"), names)
        stored = "".join("".join(output["text"]) for output in cell["outputs"] if output["output_type"] == "stream")
        assert words(stored) == words(capsys.readouterr().out), f"code cell {number}: `make notebooks` stores the outputs"
