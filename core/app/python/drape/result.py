"""What a run has written."""

from __future__ import annotations

import html
from typing import Mapping, Sequence

from . import _core
from .page import Page


class Table(Mapping):
    """Columns of equal length by name; numbers are numpy arrays with nan where absent, words are lists."""

    def __init__(self, columns: dict):
        self._columns = columns

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


class Result:
    """A run's results: result["pcs"].levels[-1].x is the finest state of a method.

    A notebook shows the report's 3D viewer of all methods side by side.
    """

    def __init__(self, record: _core.RunRecord):
        self._record = record
        self.levels = Table(record._levels())
        """One row for each level of each method: status, cost, energies, state metrics."""
        self.iterations = Table(record._iterations())
        """One row for each Newton iteration: energy [J], force residual, step size [s], …"""
        self.consistency = Table(record._consistency())
        """One row for each pair of levels: pair metrics of the prolonged coarse state against the fine one."""
        self.errors = Table(record._errors())
        """One row for each snapshot: its cost, and its errors against the method's own end and the reference."""

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
        """Error over cost, a line for each method, in the report's colours; returns matplotlib's axes."""
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


def read_run(folder) -> Result:
    """The results of a run, finished or interrupted. Raises RuntimeError for a folder without one."""
    return Result(_core.RunRecord(folder))
