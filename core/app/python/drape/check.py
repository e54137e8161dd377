"""Checks of prototypes."""

from __future__ import annotations

from typing import Optional

import numpy

from . import _core


def check_energy(energy, level: Optional[_core.Level] = None, material: Optional[_core.Material] = None, x=None,
                 step: float = 1e-5, tolerance: float = 1e-5) -> bool:
    """Compare an energy's derivatives with finite differences; print the largest errors, and where they are.

    energy: a drape.Energy object, a plugin's name, or a dict with its parameters.
    level: a small one; by default a square of 36 vertices with sides of 0.5 m.
    x: n×3 [m]; by default the rest shape with noise.
    step: of the differences [m]. Returns whether every relative error is within the tolerance.
    """
    if level is None:
        level = _square(6, 0.5)
    if x is None:
        x = level.rest + 0.02 * numpy.random.default_rng(1).standard_normal(level.rest.shape)
    bound = _core.bind_energy(energy, level, _core.Material() if material is None else material)
    found = bound.check(x, step)
    vertex, axis = found["gradient_at"]
    print(f"gradient: largest error {found['gradient']:.2e}, at vertex {vertex}, {'xyz'[axis]}")
    row, a, column, b = found["hessian_at"]
    print(f"hessian: largest error {found['hessian']:.2e}, at vertices {row}, {'xyz'[a]} and {column}, "
          f"{'xyz'[b]}; asymmetry {found['asymmetry']:.2e}")
    return all(found[name] <= tolerance for name in ("gradient", "hessian", "asymmetry"))


def _square(side: int, length: float) -> _core.Level:
    """A flat square of side × side vertices, every cell cut in two."""
    j, i = numpy.mgrid[0:side, 0:side]
    rest = numpy.stack([i.ravel(), j.ravel(), 0 * i.ravel()], axis=1) * (length / (side - 1))
    a = (i + side * j)[:-1, :-1].ravel()
    lower = numpy.stack([a, a + 1, a + side + 1], axis=1)
    upper = numpy.stack([a, a + side + 1, a + side], axis=1)
    return _core.Level(rest, numpy.concatenate([lower, upper]))
