"""Prototypes: energies, metrics, refiners and solvers in Python, chosen by name as plugins are.

A prototype is made for every experiment that names it, with the experiment's parameters as keyword arguments.
Evaluation must depend on the arguments alone: the solvers rely on that. What it raises is raised from `run`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy
import scipy.sparse

from . import _core


@dataclass(frozen=True)
class Parameter:
    """A parameter of a prototype: its default (bool, int, float or str), unit (SI), bounds, description."""

    default: Union[bool, int, float, str]
    unit: str = ""
    minimum: Optional[float] = None
    maximum: Optional[float] = None
    description: str = ""
    source: str = ""


@dataclass(frozen=True)
class Column:
    """A value of a metric: unit ("1" if dimensionless), which way is better (lower, higher, neither), the label
    in reports, the name with spaces if None, and the name that errors.csv has it under, for pair metrics; empty for none."""

    unit: str = "1"
    better: str = "lower"
    label: Optional[str] = None
    error: str = ""


def _shown(value: Any) -> str:
    """For messages, which an array's numbers would fill."""
    return f"an array of the shape {value.shape}" if isinstance(value, numpy.ndarray) else repr(value)


def _is_number(value: Any) -> bool:
    return hasattr(value, "__float__") and numpy.ndim(value) == 0 and not numpy.iscomplexobj(value)


class _Prototype:
    parameters: dict = {}
    """From a name to a Parameter or a plain default."""

    def __init__(self, **parameters: Any):
        declared = self._declared_parameters()
        for name in parameters:
            if name not in declared:
                raise TypeError(f"{type(self).__name__} has no parameter \"{name}\"")
        for name, parameter in declared.items():
            setattr(self, name, parameters.get(name, parameter.default))

    @classmethod
    def _declared_parameters(cls) -> dict:
        owner, parameters = cls.__name__, cls.parameters
        if not isinstance(parameters, dict):
            raise TypeError(f"{owner}.parameters must be a dict from names to defaults or drape.Parameters, "
                            f"not {_shown(parameters)}")
        base = next(base for base in cls.__mro__ if base.__module__ == __name__)
        for name in parameters:
            if not isinstance(name, str):
                raise TypeError(f"{owner}.parameters: a name must be a str, not {name!r}")
            if hasattr(base, name):
                raise ValueError(f"{owner}.parameters: \"{name}\" needs another name: drape.{base.__name__} has an "
                                 f"attribute \"{name}\"")
        return {name: value if isinstance(value, Parameter) else Parameter(value) for name, value in parameters.items()}

    def _undefined(self, method: str) -> NotImplementedError:
        return NotImplementedError(f"{type(self).__name__} must define {method}")

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """The value of a parameter, which __init__ sets."""


class Energy(_Prototype):
    """An energy that is a sum over elements; all of a level are evaluated at once.

    m elements of k vertices; x is m×k×3 [m], the elements' corners.
    """

    role = "membrane"
    """membrane, bending, external (the load, which scales the force residual) or position."""
    midpoint_factor: Optional[float] = None
    """Factor on the energy if every triangle is split into four at its midpoints; None if there is none."""

    def elements(self, level: _core.Level) -> numpy.ndarray:
        """m×k vertex indices, such as level.triangles, level.edges or level.hinges; no rows where a level has no
        elements, of which nothing else is called then."""
        raise self._undefined("elements(self, level)")

    def rest(self, level: _core.Level, material: _core.Material) -> Any:
        """What the evaluation needs beside x: computed once for a level, passed to each call."""
        return None

    def plate_stiffness(self, material: _core.Material) -> float:
        """Of a bending energy: D [J], if a sheet rolled to a radius r has the energy D/(2 r²) for each unit of rest area. On coarse
        levels of pcs membranes of which no bending energy has one resist no compression."""
        return 0.0

    def value(self, x: numpy.ndarray, rest: Any) -> numpy.ndarray:
        """m energies [J]; inf outside the domain."""
        raise self._undefined("value(self, x, rest)")

    def gradient(self, x: numpy.ndarray, rest: Any) -> numpy.ndarray:
        """m×k×3 derivatives [N]."""
        raise self._undefined("gradient(self, x, rest)")

    def hessian(self, x: numpy.ndarray, rest: Any) -> numpy.ndarray:
        """m×3k×3k second derivatives [N/m], symmetric, not projected: drape does that."""
        raise self._undefined("hessian(self, x, rest)")


class Metric(_Prototype):
    """A measure of a state, or of a pair of states on one level."""

    scope = "state"
    """state, or pair: a coarse state, prolonged, against a fine one."""
    columns: dict = {}
    """From the name of each value that `measure` returns to its Column; at least one."""

    def measure(self, level: _core.Level, x: numpy.ndarray, other: Optional[numpy.ndarray]) -> dict:
        """Values by the names in `columns`. x is n×3 [m], of a pair the fine state; `other` is the coarse one."""
        raise self._undefined("measure(self, level, x, other)")

    def _declared(self) -> dict:
        owner, columns = type(self).__name__, self.columns
        if not isinstance(columns, dict) or not columns:
            raise TypeError(f"{owner}.columns must be a dict with a drape.Column for every value that measure returns, "
                            f"such as {{\"height\": drape.Column(\"m\")}}, not {columns!r}")
        for name, column in columns.items():
            if not isinstance(name, str):
                raise TypeError(f"{owner}.columns: a name must be a str, not {name!r}")
            if not isinstance(column, Column):
                raise TypeError(f"{owner}.columns: \"{name}\" must be a drape.Column, such as drape.Column(\"m\"), "
                                f"not {column!r}")
        return columns

    def _measured(self, level: _core.Level, x: numpy.ndarray, other: Optional[numpy.ndarray]) -> dict:
        owner, values = type(self).__name__, self.measure(level, x, other)
        if not isinstance(values, dict):
            raise TypeError(f"{owner}.measure must return a dict from the names in {owner}.columns to numbers, "
                            f"not {_shown(values)}")
        for name, value in values.items():
            if name not in self.columns:
                raise ValueError(f"{owner}.measure returned \"{name}\", which is not in {owner}.columns; "
                                 "add it there with its drape.Column")
            if not _is_number(value):
                raise TypeError(f"{owner}.measure must return a number for \"{name}\", not {_shown(value)}")
        return values


class Refiner(_Prototype):
    """Where the vertices of a 1→4 subdivision lie, by the rest shape alone."""

    def weights(self, level: _core.Level):
        """A sparse (n + e)×n matrix whose rows sum to 1: of the vertices first, then of a new vertex for each of
        level.edges."""
        raise self._undefined("weights(self, level)")

    def _matrix(self, level: _core.Level) -> scipy.sparse.csr_matrix:
        answer = self.weights(level)
        try:
            matrix = scipy.sparse.csr_matrix(answer, copy=True)  # pybind11 takes none that is read-only, as a scene's
            if matrix.dtype.kind in "biuf":
                return matrix
        except (TypeError, ValueError):
            pass
        raise TypeError(f"{type(self).__name__}.weights must return a sparse (n + e)×n matrix of real numbers, "
                        f"not {_shown(answer)}")


class Solver(_Prototype):
    """A method: what it does on the levels of a problem, in order."""

    def solve(self, problem: _core.Problem) -> None:
        """For each level, from coarse to fine: problem.begin(l), problem.iteration(x) as it goes,
        problem.end(x, status)."""
        raise self._undefined("solve(self, problem)")


def register(name: str, prototype: type) -> type:
    """Register a prototype under the name that experiments use; it replaces an earlier one of that name.

    Raises TypeError for a class that is not derived from Energy, Metric, Refiner or Solver, and for parameters or a
    metric's columns of a wrong type; ValueError for a parameter that has the name of an attribute, a metric's `scope` or
    a column's `better` that does not exist, and a column that results.json or another metric has already; RuntimeError if
    a plugin's library has the name. Call it while no experiment is being read in another thread.
    """
    for kind in (Energy, Metric, Refiner, Solver):
        if isinstance(prototype, type) and issubclass(prototype, kind):
            _core._register(kind.__name__.lower(), name, prototype)
            return prototype
    raise TypeError(f"{prototype!r} is not a class derived from Energy, Metric, Refiner or Solver")


def check_energy(energy, level: Optional[_core.Level] = None, material: Optional[_core.Material] = None, x=None,
                 step: float = 1e-5, tolerance: float = 1e-5) -> bool:
    """Compare an energy's derivatives with finite differences, and its midpoint_factor, if it has one, with the energy of
    the mesh split at midpoints; walk through strains and bends in search of jumps of energy and force; print the
    largest errors, and where they are.

    energy: a drape.Energy object, a plugin's name, or a dict with its parameters.
    level: a small one; by default that of `drape check-energy`, four square cells of 1 cm.
    x: n×3 [m]; by default the rest shape stretched, sheared and bent.
    step: of the differences [m]. Returns whether every relative error is within the tolerance and nothing jumps.
    """
    bound = _core.bind_energy(energy, level or _core._checked_level(), material or _core.Material())
    worst, text, jump = _core._check_energy(bound, x, step)
    print(text, end="")
    if jump:
        print("NOT SMOOTH: " + jump)
    return worst <= tolerance and not jump
