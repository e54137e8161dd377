"""What the tests of the Python module share. PYTHONPATH names the module's folder, DRAPE_BIN that of the command."""

import copy
import os
import pathlib
import subprocess
import sys

import pytest

import drape

# The sanitizer's runtime that this interpreter was given: commands have one of their own, other interpreters need it again.
PRELOADED = {name: os.environ.pop(name) for name in ("LD_PRELOAD",) if name in os.environ}
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(pathlib.Path(__file__).parent), str(SOURCE / "tests/support")]

# A square of 6×6 vertices on two corners, two levels: solved in milliseconds.
SMALL_FILE = SOURCE / "tests/configs/data/small.yaml"
SMALL = {
    "name": "small",
    "cloth": {"shape": "square", "side": 1, "columns": 6, "rows": 6},
    "levels": 2,
    "start": {"scale": [0.9, 0.9, 1], "perturbation": 1e-3},
    "pins": [{"region": "nearest", "point": [0, 0, 0]}, {"region": "nearest", "point": [1, 0, 0]}],
    "energies": ["neo_hookean", "hinge", "gravity"],
    "newton": {"force_tolerance": 1e-2},
    "methods": {"pcs": {}, "cascadic": {}, "newton": {}},
    "reference": "newton",
}


def command(*words, code=0, **process):
    """Runs drape, which must end with this exit code, and returns it with its output."""
    ended = subprocess.run([pathlib.Path(os.environ["DRAPE_BIN"]) / "drape", *words], capture_output=True, text=True, **process)
    assert ended.returncode == code, ended.stderr
    return ended


def run(experiment, **options):
    """The result of an experiment, or of its dict, without progress."""
    if isinstance(experiment, dict):
        experiment = drape.Experiment(experiment)
    return experiment.run(progress=False, **options)


def bits_of(result, method="pcs"):
    """The bits of a method's last state."""
    return result[method].levels[-1].x.tobytes()


def statuses_of(solved):
    """How the levels of a method, or of a solve, ended."""
    return [level.status for level in solved.levels]


def own(base, **attributes):
    """A class in Python that is derived from this one."""
    return type("Own", (base,), attributes)


def with_membrane(experiment, energy):
    """The experiment with this energy in Python in place of its first."""
    drape.register("own_membrane", energy)
    return {**experiment, "energies": ["own_membrane", *experiment["energies"][1:]]}


def solved_by(experiment, solver):
    """The experiment with own_solver as its only method: a class, or a function that solves a problem."""
    if not isinstance(solver, type):
        solver = own(drape.Solver, solve=lambda self, problem, solve=solver: solve(problem))
    drape.register("own_solver", solver)
    return {**experiment, "methods": {"own_solver": {}}, "reference": {}}


@pytest.fixture
def small():
    """The experiment of SMALL_FILE as a dict, to be changed at will."""
    return copy.deepcopy(SMALL)


@pytest.fixture
def experiment(small):
    return drape.Experiment(small)


@pytest.fixture
def scene(experiment):
    return experiment.scene()
