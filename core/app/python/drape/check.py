"""Checks of prototypes."""

from __future__ import annotations

from typing import Optional

from . import _core


def check_energy(energy, level: Optional[_core.Level] = None, material: Optional[_core.Material] = None, x=None,
                 step: float = 1e-5, tolerance: float = 1e-5) -> bool:
    """Compare an energy's derivatives with finite differences; print the largest errors, and where they are.

    energy: a drape.Energy object, a plugin's name, or a dict with its parameters.
    level: a small one; by default that of `drape check-energy`, four square cells of 1 cm.
    x: n×3 [m]; by default the rest shape stretched, sheared and bent.
    step: of the differences [m]. Returns whether every relative error is within the tolerance.
    """
    if level is None:
        level = _core._checked_level()
    if x is None:
        x = _core._checked_state(level)
    found = _core.bind_energy(energy, level, _core.Material() if material is None else material).check(x, step)
    print(found["text"], end="")
    return found["worst"] <= tolerance
