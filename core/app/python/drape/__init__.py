"""Progressive cloth quasistatics: experiments, states and prototypes from Python.

    import drape
    result = drape.Experiment("configs/sphere.yaml").run(methods=["pcs"])
    result["pcs"].levels[-1].x          # n×3 positions [m], a read-only numpy array

All numbers are SI. docs/guide/python.md is the guide.
"""

from ._core import (
    BoundEnergy,
    Checkpoint,
    Iteration,
    Level,
    LevelRecord,
    LevelResult,
    Material,
    MethodRecord,
    Model,
    Problem,
    RunAborted,
    Scene,
    Solve,
    __commit__,
    __version__,
    bind_energy,
    plugins,
    set_threads,
)
from .check import check_energy
from .errors import ConfigError, ConfigFault
from .experiment import Experiment
from .page import Page
from .prototypes import Column, Energy, Metric, Parameter, Refiner, Solver, register
from .result import Result, Table, read_run, read_sweep

__all__ = [
    "BoundEnergy", "Checkpoint", "Column", "ConfigError", "ConfigFault", "Energy", "Experiment", "Iteration",
    "Level", "LevelRecord", "LevelResult", "Material", "MethodRecord", "Metric", "Model", "Page", "Parameter",
    "Problem", "Refiner", "Result", "RunAborted", "Scene", "Solve", "Solver", "Table", "__commit__",
    "__version__", "bind_energy", "check_energy", "plugins", "read_run", "read_sweep", "register", "set_threads", "show",
]


def show(scene: Scene, x, level: int = -1) -> Page:
    """The 3D viewer of a state x (n×3) [m] of a scene's level: a notebook shows it, `.open()` a browser."""
    return Page(scene.page(x, level))
