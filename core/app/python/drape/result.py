"""What a run has written, and pages that show it."""

from __future__ import annotations

import html
import io
import json
import os
import pathlib
import tempfile
import webbrowser
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Tuple, Union

import numpy
import pandas

from . import _core, plots


class Page:
    """An HTML page that needs no other file and no network."""

    def __init__(self, text: str):
        self.text = text

    def open(self) -> pathlib.Path:
        """Open the page in a browser; returns the file, which stays."""
        with tempfile.NamedTemporaryFile("w", suffix=".html", prefix="drape_", delete=False,
                                         encoding="utf-8") as file:
            file.write(self.text)
        webbrowser.open(pathlib.Path(file.name).as_uri())
        return pathlib.Path(file.name)

    def _repr_html_(self) -> str:
        # A frame keeps the page's scripts and styles apart from the notebook's.
        return (f'<iframe srcdoc="{html.escape(self.text)}" width="100%" height="620" '
                'style="border: 0" sandbox="allow-scripts allow-downloads"></iframe>')


def show(scene: _core.Scene, x, level: int = -1) -> Page:
    """The 3D viewer of a state x (n×3) [m] of a scene's level: a notebook shows it, `.open()` a browser."""
    return Page(scene._page(x, level))


class _Record:
    """Its attributes are the values of results.json, by their names there; None where one is absent."""

    def __init__(self, run: Result, values: Mapping[str, Any]):
        vars(self).update({**values, "_run": run})

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{name} cannot be set: a record is what the run has written")

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """A value of results.json."""


class LevelRecord(_Record):
    """The last state of one level of one method: `status`, `seconds`, `energy`, `largest_stretch` and all else that
    results.json has of it, by name; None where a number is absent."""

    @property
    def x(self) -> numpy.ndarray:
        """n×3 positions [m], read-only. Raises RuntimeError where the level has failed, or its file is damaged."""
        return self._run._mesh(self)[0]

    @property
    def triangles(self) -> numpy.ndarray:
        """m×3 vertex indices, read-only."""
        return self._run._mesh(self)[1]


class MethodRecord(_Record):
    """One method of a run: `status`, `solver`, `seconds`, `peak_memory_bytes`, and `levels`, coarse to fine."""

    name: str
    levels: List[LevelRecord]

    def __init__(self, run: Result, name: str, values: Mapping[str, Any]):
        levels = [LevelRecord(run, {k: v for k, v in level.items() if k != "triangles"}) for level in values["levels"]]
        super().__init__(run, {**values, "name": name, "levels": levels})


def _tidy(frame: pandas.DataFrame) -> pandas.DataFrame:
    """Columns without any number are columns of numbers all the same."""
    return frame.astype({name: float for name in frame if frame[name].isna().all()})


def _rows(methods: Mapping[str, Any], entries: str) -> pandas.DataFrame:
    """One row for each entry of each method; numbers within an object by their path, as energy_parts.gravity."""
    rows = [{"method": name, **{k: v for k, v in entry.items() if k != "snapshots"}}
            for name, method in methods.items() for entry in method[entries]]
    return _tidy(pandas.json_normalize(rows))


def _read_csv(file: pathlib.Path) -> pandas.DataFrame:
    if not file.is_file():
        return pandas.DataFrame()
    text = file.read_text(encoding="utf-8")
    whole = text[:text.rfind("\n") + 1]  # a killed run may leave a part of a line
    # A converter, since na_values would count for a dtype's texts: a method may have the name nan.
    return _tidy(pandas.read_csv(io.StringIO(whole), converters={"method": str}, float_precision="round_trip",
                                 keep_default_na=False, na_values=["", "nan", "-nan"]))


class Result:
    """A run's results: result["pcs"].levels[-1].x is the finest state of a method.

    A notebook shows the report's 3D viewer of all methods side by side. Tables are pandas.DataFrames. A result can be
    pickled, as for another process, unless its folder is temporary: its states are read from there.
    """

    _temporary = False

    def __init__(self, folder: Union[str, os.PathLike]):
        self.folder = os.fspath(folder)
        """The results folder; a temporary one goes away with this object."""
        path = pathlib.Path(folder)
        try:
            record = json.loads((path / "results.json").read_text(encoding="utf-8"))
            self._methods: Dict[str, Any] = record["methods"]
            self.experiment: str = record["experiment"]
            self.complete: bool = record["complete"]
            """Whether every method ended by itself."""
            self.levels = _rows(self._methods, "levels")
            """results.json's levels, one row for each of each method: status, cost, energies, state metrics."""
            self.consistency = _rows(self._methods, "consistency")
            """One row for each pair of levels: pair metrics of the prolonged coarse state against the fine one."""
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            raise RuntimeError(f"{path / 'results.json'} is not a run's record ({error}); name the results folder of a run") \
                from error
        self.iterations = _read_csv(path / "iterations.csv")
        """iterations.csv, one row for each Newton iteration: energy [J], force residual, step size [s], …"""
        self.errors = _read_csv(path / "errors.csv")
        """errors.csv, one row for each snapshot: its cost, and its errors against the method's own end and the
        reference."""
        self._meshes: Dict[str, Tuple[numpy.ndarray, numpy.ndarray]] = {}

    def __getstate__(self) -> Dict[str, Any]:
        if self._temporary:
            raise TypeError("this result cannot be pickled or copied, because its folder is temporary; give run a folder, as "
                            "in out=\"results/mine\"")
        return {**vars(self), "folder": os.path.abspath(self.folder), "_meshes": {}}

    def __getitem__(self, method: str) -> MethodRecord:
        if method not in self._methods:
            raise KeyError(f"the run has no method \"{method}\"")
        return MethodRecord(self, method, self._methods[method])

    @property
    def methods(self) -> List[str]:
        return list(self._methods)

    def _mesh(self, level: LevelRecord) -> Tuple[numpy.ndarray, numpy.ndarray]:
        record = {key: vars(level).get(key) for key in ("mesh", "mesh_checksum")}
        name = record["mesh"]
        if not name:
            raise RuntimeError("the run has stored no state of this level")
        if name not in self._meshes:
            arrays = _core._read_mesh(self.folder, json.dumps(record))
            for array in arrays:
                array.setflags(write=False)
            self._meshes[name] = arrays
        return self._meshes[name]

    @property
    def page(self) -> Page:
        """The report's 3D viewer of every state."""
        return Page(_core._run_page(self.folder))

    def show(self) -> None:
        """Open the 3D viewer in a browser."""
        self.page.open()

    plot_errors = plots.plot_errors
    plot_convergence = plots.plot_convergence

    def _repr_html_(self) -> str:
        return self.page._repr_html_()

    def _repr_png_(self) -> Optional[bytes]:
        # For pages that show no frames: the end of the first method that has a state.
        drawn = next((name for name in self.methods if any(vars(level).get("mesh") for level in self[name].levels)), None)
        if drawn is None:
            return None
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "end.png")
            _core._draw(self.folder, file, drawn, width=480)
            return file.read_bytes()

    def __repr__(self) -> str:
        return f"<drape.Result of {self.experiment}: {', '.join(self.methods)}>"


def read_sweep(folder) -> pandas.DataFrame:
    """A sweep as one table, that of `drape table`: a row for each method of each run, with a column for every
    varied key and one for the seed. Of the folder of a run: a row for each of its methods.

    Raises RuntimeError for a folder of neither.
    """
    return _tidy(pandas.DataFrame(json.loads(_core._table(folder))))


def read_run(folder) -> Result:
    """The results of a run, finished or interrupted. Raises RuntimeError for a folder without one."""
    return Result(folder)
