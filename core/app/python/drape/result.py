"""What a run has written."""

from __future__ import annotations

import csv
import html
import json
import pathlib
from typing import Any, Iterable, Mapping, Sequence

import numpy

from . import _core
from .page import Page


def _column(values: list):
    """Whole numbers, or numbers with nan where one is absent, as an array; a list of words otherwise."""
    if any(isinstance(value, str) for value in values):
        return ["" if value is None else str(value) for value in values]
    if all(isinstance(value, (bool, int)) for value in values):
        return numpy.array(values)
    return numpy.array([numpy.nan if value is None else value for value in values], dtype=float)


class Table(Mapping):
    """Columns of equal length by name; numbers are numpy arrays with nan where absent, words are lists."""

    def __init__(self, rows: Iterable[Mapping[str, Any]]):
        rows = list(rows)
        names = dict.fromkeys(name for row in rows for name in row)
        self._columns = {name: _column([row.get(name) for row in rows]) for name in names}

    def __getitem__(self, name: str):
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self) -> int:
        """The number of columns."""
        return len(self._columns)

    @property
    def row_count(self) -> int:
        return max((len(values) for values in self._columns.values()), default=0)

    def to_pandas(self):
        """The table as a pandas.DataFrame. Raises ImportError without pandas."""
        import pandas

        return pandas.DataFrame(self._columns)

    def _repr_html_(self) -> str:
        def cell(value) -> str:
            return html.escape(value if isinstance(value, str) else f"{value:.4g}")

        most = 60
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self)
        rows = zip(*(list(values)[:most] for values in self._columns.values()))
        body = "".join("<tr>" + "".join(f"<td>{cell(v)}</td>" for v in row) + "</tr>" for row in rows)
        rest = self.row_count - most
        more = f"<p>and {rest} more rows</p>" if rest > 0 else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _read_csv(file: pathlib.Path) -> Table:
    def value(name: str, cell: str):
        if name == "method":
            return cell
        try:
            return int(cell)
        except ValueError:
            return float(cell) if cell else None

    if not file.exists():
        return Table([])
    with file.open(newline="", encoding="utf-8") as lines:
        names, *rows = csv.reader(lines)
    whole = (row for row in rows if len(row) == len(names))  # a killed run may leave a part of a line
    return Table({name: value(name, cell) for name, cell in zip(names, row)} for row in whole)


def _flat(entry: Mapping[str, Any]) -> dict:
    """The numbers and words of an entry of results.json; numbers within an object by their path."""
    row = {}
    for name, value in entry.items():
        if isinstance(value, dict):
            if not any(isinstance(part, (str, list, dict)) for part in value.values()):
                row.update({f"{name}.{part}": number for part, number in value.items()})
        elif not isinstance(value, list):
            row[name] = value
    return row


class Result:
    """A run's results: result["pcs"].levels[-1].x is the finest state of a method.

    A notebook shows the report's 3D viewer of all methods side by side.
    """

    def __init__(self, record: _core.RunRecord):
        self._record = record
        folder = pathlib.Path(record.folder)
        methods = json.loads((folder / "results.json").read_text(encoding="utf-8"))["methods"]

        def rows(entries: str) -> Table:
            return Table({"method": name, **_flat(entry)} for name in record.methods for entry in methods[name][entries])

        self.levels = rows("levels")
        """results.json's levels, one row for each of each method: status, cost, energies, state metrics."""
        self.iterations = _read_csv(folder / "iterations.csv")
        """iterations.csv, one row for each Newton iteration: energy [J], force residual, step size [s], …"""
        self.consistency = rows("consistency")
        """One row for each pair of levels: pair metrics of the prolonged coarse state against the fine one."""
        self.errors = _read_csv(folder / "errors.csv")
        """errors.csv, one row for each snapshot: its cost, and its errors against the method's own end and the
        reference."""

    def __getitem__(self, method: str) -> _core.MethodRecord:
        return self._record[method]

    @property
    def methods(self) -> Sequence[str]:
        return self._record.methods

    @property
    def folder(self) -> str:
        """The results folder; a temporary one goes away with this object."""
        return self._record.folder

    @property
    def complete(self) -> bool:
        """Whether every method ended by itself."""
        return self._record.complete

    @property
    def page(self) -> Page:
        """The report's 3D viewer of every state."""
        return Page(self._record.page())

    def show(self) -> None:
        """Open the 3D viewer in a browser."""
        self.page.open()

    def plot_errors(self, measure: str = "", target: str = "reference", cost: str = "seconds", axes=None):
        """Error over cost, a line for each method, in the report's colours; returns matplotlib's axes.

        measure: as in errors.csv; by default the first there, rms unless the experiment leaves it out. A method
        whose levels do not build on each other has its finest level alone.
        """
        from .plots import plot_errors

        return plot_errors(self, measure, target, cost, axes)

    def plot_convergence(self, axes=None):
        """Force residual over time, a line for each level of each method; returns matplotlib's axes."""
        from .plots import plot_convergence

        return plot_convergence(self, axes)

    def _repr_html_(self) -> str:
        return self.page._repr_html_()

    def __repr__(self) -> str:
        return f"<drape.Result of {self._record.experiment}: {', '.join(self.methods)}>"


def read_sweep(folder) -> Table:
    """A sweep as one table, that of `drape table`: a row for each method of each run, with a column for every
    varied key and one for the seed; `.to_pandas()` makes a DataFrame.

    Raises RuntimeError for a folder without a sweep.
    """
    return Table(json.loads(_core._table(folder)))


def read_run(folder) -> Result:
    """The results of a run, finished or interrupted. Raises RuntimeError for a folder without one."""
    return Result(_core.RunRecord(folder))
