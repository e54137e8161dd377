"""A method step by step."""

import gc
import importlib
import json
import os
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy
import pytest

import drape
from conftest import PRELOADED, SOURCE, bits_of, run, statuses_of, with_membrane
from prototypes import Springs


@pytest.fixture
def two_drapes(monkeypatch):
    monkeypatch.syspath_prepend(SOURCE / "benchmarks")
    return importlib.import_module("two_drapes")


def test_iterations_have_the_bits_of_a_run(experiment):
    whole, solver = run(experiment), experiment.solver("pcs")
    iterations = list(solver)
    residuals = [iteration.force_residual for iteration in iterations]
    assert numpy.allclose(residuals, whole.iterations["force_residual"], rtol=1e-8)
    assert solver.levels[-1].x.tobytes() == bits_of(whole) == iterations[-1].x.tobytes()
    assert statuses_of(solver) == ["converged", "converged"]
    assert iterations[-1].method == solver.levels[0].method == "pcs"
    assert list(solver) == []


@pytest.mark.parametrize("name", ["hanging", "draped"])
def test_a_comparison_comes_to_rest_and_goes_on_where_it_was_cut(two_drapes, tmp_path, name):
    seconds, states, level = two_drapes.solved(two_drapes.experiment_of(name, 9, seed=1))
    assert level.status == "converged" and len(seconds) == len(states) == level.iterations
    assert len(two_drapes.solved(two_drapes.experiment_of(name, 9, seed=1), most=3)[1]) == 3
    measured = []

    def measure(scene, vertices, seed, folder):
        assert folder.is_dir()
        measured.append(seed)
        model, start, end = two_drapes.drape_end(scene, vertices, seed)
        assert start.shape == model.level.rest.shape
        return {"drape": end}

    for seeds in ((1,), (1, 2)):
        two_drapes.measure_all(tmp_path / "record.json", {"benchmark": "test"},
                               [{"scene": name, "vertices": 81, "seed": seed} for seed in seeds], measure)
    assert measured == [1, 2]
    runs = json.loads((tmp_path / "record.json").read_text())["runs"]
    assert [record["seed"] for record in runs] == [1, 2]
    for end in (record["drape"] for record in runs):
        assert end["intersections"] == 0 and end["force_residual"] < 1e-3 < end["seconds"]


def test_a_comparison_that_is_told_to_end_ends_what_it_has_started(two_drapes, tmp_path):
    cut = "import os, pathlib, two_drapes; " \
        "two_drapes.measure_all(pathlib.Path('cut.json'), {}, [{'seed': 1}], lambda **_: os.kill(os.getpid(), 15))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    assert subprocess.run([sys.executable, "-c", cut], cwd=tmp_path, env=environment).returncode == 143


def test_stop_and_refine(experiment):
    solver = experiment.solver("pcs")
    next(solver)
    solver.refine()
    assert next(solver).level == 1
    solver.stop()
    assert list(solver) == []
    assert statuses_of(solver) == ["refined_early_on_request", "cancelled"]


def test_a_checkpoint_goes_on_to_the_same_bits(experiment, small):
    expected = [iteration.x.tobytes() for iteration in experiment.solver("pcs")]
    part = experiment.solver("pcs")
    for _ in range(3):
        next(part)
    checkpoint = part.checkpoint()
    del part
    gc.collect()
    states = [iteration.x.tobytes() for iteration in experiment.solver("pcs", start=checkpoint)]
    assert states == expected[2:]  # the checkpoint's step is repeated
    with pytest.raises(RuntimeError, match="method pcs"):
        experiment.solver("cascadic", start=checkpoint)
    for key, value in (("cloth.columns", 7), ("levels", 1), ("material.density", 900)):
        other = drape.Experiment(small)
        other.set(key, value)
        with pytest.raises(RuntimeError, match="other values"):
            other.solver("pcs", start=checkpoint)


def test_a_checkpoint_after_a_change_goes_on_from_the_same_state(experiment, small):
    whole = experiment.solver("newton")
    next(whole)
    whole.set("material.density", 900.0)
    checkpoint = whole.checkpoint()
    changed = drape.Experiment(small)
    changed.set("material.density", 900.0)
    resumed = changed.solver("newton", start=checkpoint)
    assert [i.x.tobytes() for i in resumed] == [i.x.tobytes() for i in whole]


def test_a_parameter_changes_between_steps(experiment):
    solver = experiment.solver("newton")
    with pytest.raises(RuntimeError, match="nothing is iterated"):
        solver.set("material.density", 900)
    x = next(solver).x
    solver.set("material.density", 900.0)
    assert numpy.array_equal(solver.scene.start(0), x)
    solver.set("pins.0.translate", [0, 0, 0.2])
    for _ in solver:
        pass
    assert solver.scene[0].material.density == 900
    assert abs(solver.levels[0].x[0, 2] - 0.2) < 1e-5
    again = experiment.solver("newton")
    next(again)
    for key, value in (("material.density", -1), ("cloth.columns", 7)):
        with pytest.raises(drape.ConfigError, match=key.split(".")[0]):
            again.set(key, value)
    next(again)  # goes on as it was


def test_a_solve_may_be_left_at_any_time(experiment):
    for _ in range(20):
        next(experiment.solver("pcs"))
    gc.collect()
    never = experiment.solver("pcs")
    del never


def test_a_solve_that_is_left_at_exit_ends(small):
    springs = {**small, "energies": ["springs", "hinge", "gravity"]}
    script = f"""
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
import drape, prototypes
drape.register("springs", prototypes.Springs)
solver = drape.Experiment({springs!r}).solver("newton")
next(solver)
"""
    ended = subprocess.run([sys.executable, "-c", script], env={**os.environ, **PRELOADED}, capture_output=True,
                           text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_solve_is_of_one_thread_at_a_time(small):
    solvers, refused = [], []

    def advance():
        with pytest.raises(RuntimeError, match="being advanced"):
            next(solvers[0])
        refused.append(True)

    class Meddling(Springs):
        """Has another thread advance the solve that evaluates it."""

        def gradient(self, x, rest):
            if solvers and not refused:
                with ThreadPoolExecutor(1) as thread:
                    thread.submit(advance).result()
            return super().gradient(x, rest)

    solvers.append(drape.Experiment(with_membrane(small, Meddling)).solver("newton"))
    next(solvers[0])
    assert refused
    solvers.clear()
