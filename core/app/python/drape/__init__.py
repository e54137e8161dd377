"""Progressive cloth quasistatics: experiments, states and prototypes from Python.

    import drape
    result = drape.Experiment("configs/sphere.yaml").run(methods=["pcs"])
    result["pcs"].levels[-1].x          # n×3 positions [m], a read-only numpy array

All numbers are SI. docs/guide/python.md is the guide.
"""

import importlib

try:
    for needed in ("numpy", "scipy", "pandas", "drape._core"):
        importlib.import_module(needed)
except ImportError as error:
    import pathlib
    import sys

    built = [file.name for file in pathlib.Path(__file__).parent.glob("_core.*.so")]
    raise ImportError(
        f"{error}: drape was imported by {sys.executable}, Python {sys.version.split()[0]}. `make python` builds it for "
        f"/usr/bin/python3, with numpy, scipy and pandas; take that one, or install the wheel of `make wheel` "
        f"(modules here: {', '.join(built) or 'none'})") from error

from ._core import (
    BoundEnergy,
    Checkpoint,
    Iteration,
    Level,
    LevelResult,
    Material,
    Model,
    Problem,
    RunAborted,
    Scene,
    Solve,
    __commit__,
    __version__,
    bind_energy,
    load_plugin,
    plugins,
    set_threads,
)
from .experiment import ConfigError, ConfigFault, Experiment, resume
from .prototypes import Column, Energy, Metric, Parameter, Refiner, Solver, check_energy, register
from .result import LevelRecord, MethodRecord, Page, Result, read_run, read_sweep, show
from .sweeps import sweep


def figures(results, out, **options):
    """Write the figures of a run or a sweep to a folder: see drape.paper.figures, which needs matplotlib."""
    return importlib.import_module("drape.paper").figures(results, out, **options)


__all__ = [
    "BoundEnergy", "Checkpoint", "Column", "ConfigError", "ConfigFault", "Energy", "Experiment", "Iteration",
    "Level", "LevelRecord", "LevelResult", "Material", "MethodRecord", "Metric", "Model", "Page", "Parameter",
    "Problem", "Refiner", "Result", "RunAborted", "Scene", "Solve", "Solver", "__commit__", "__version__",
    "bind_energy", "check_energy", "figures", "load_plugin", "plugins", "read_run", "read_sweep", "register", "resume", "set_threads",
    "show", "sweep",
]
