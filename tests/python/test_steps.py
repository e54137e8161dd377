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
from conftest import PRELOADED, SOURCE


@pytest.fixture
def two_drapes(monkeypatch):
    monkeypatch.syspath_prepend(SOURCE / "benchmarks")
    return importlib.import_module("two_drapes")


def test_iterations_have_the_bits_of_a_run(experiment):
    run = experiment.run(progress=False)
    solver = experiment.solver("pcs")
    residuals, states = [], []
    for iteration in solver:
        residuals.append(iteration.force_residual)
        states.append(iteration.x)
    assert numpy.allclose(residuals, run.iterations["force_residual"], rtol=1e-8)
    assert solver.levels[-1].x.tobytes() == run["pcs"].levels[-1].x.tobytes() == states[-1].tobytes()
    assert [level.status for level in solver.levels] == ["converged", "converged"]
    assert iteration.method == solver.levels[0].method == "pcs"
    assert list(solver) == []


def test_the_scenes_beside_other_programs_come_to_rest(two_drapes):
    for name in two_drapes.SCENES:
        seconds, states, level = two_drapes.solved(two_drapes.experiment_of(name, 9, seed=1))
        assert level.status == "converged"
        assert len(seconds) == len(states) == level.iterations
        assert len(two_drapes.solved(two_drapes.experiment_of(name, 9, seed=1), most=3)[1]) == 3


def test_a_comparison_goes_on_where_it_was_cut(two_drapes, tmp_path):
    measured = []

    def measure(scene, vertices, seed, folder):
        assert folder.is_dir()
        measured.append(seed)
        model, start, end = two_drapes.drape_end(scene, vertices, seed)
        assert start.shape == model.level.rest.shape
        return {"drape": end}

    for seeds in ((1,), (1, 2)):
        two_drapes.measure_all(tmp_path / "record.json", {"benchmark": "test"},
                               [{"scene": "hanging", "vertices": 81, "seed": seed} for seed in seeds], measure)
    assert measured == [1, 2]
    # Told to end, it ends what it has started.
    ended = "import os, pathlib, two_drapes; " \
            "two_drapes.measure_all(pathlib.Path('cut.json'), {}, [{'seed': 1}], lambda **_: os.kill(os.getpid(), 15))"
    assert subprocess.run([sys.executable, "-c", ended], cwd=tmp_path, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}).returncode == 143
    runs = json.loads((tmp_path / "record.json").read_text())["runs"]
    assert [run["seed"] for run in runs] == [1, 2]
    assert all(run["drape"]["intersections"] == 0 and run["drape"]["force_residual"] < 1e-3 < run["drape"]["seconds"] for run in runs)


def test_a_checkpoint_after_a_change_goes_on_from_the_same_state(experiment, small):
    whole = experiment.solver("newton")
    next(whole)
    whole.set("material.density", 900.0)
    checkpoint = whole.checkpoint()
    changed = drape.Experiment(small)
    changed.set("material.density", 900.0)
    resumed = changed.solver("newton", start=checkpoint)
    assert [i.x.tobytes() for i in resumed] == [i.x.tobytes() for i in whole]


def test_stop_and_refine(experiment):
    solver = experiment.solver("pcs")
    next(solver)
    solver.refine()
    assert next(solver).level == 1
    solver.stop()
    assert list(solver) == []
    assert [level.status for level in solver.levels] == ["refined_early_on_request", "cancelled"]


def test_a_checkpoint_goes_on_to_the_same_bits(experiment, small):
    whole = experiment.solver("pcs")
    expected = [iteration.x for iteration in whole]
    part = experiment.solver("pcs")
    for _ in range(3):
        next(part)
    checkpoint = part.checkpoint()
    del part
    gc.collect()
    resumed = experiment.solver("pcs", start=checkpoint)
    states = list(resumed)
    assert states[-1].x.tobytes() == expected[-1].tobytes()
    assert len(states) == len(expected) - 2  # the checkpoint's step is repeated
    with pytest.raises(RuntimeError, match="method pcs"):
        experiment.solver("cascadic", start=checkpoint)
    for key, value in (("cloth.columns", 7), ("levels", 1), ("material.density", 900)):
        other = drape.Experiment(small)
        other.set(key, value)
        with pytest.raises(RuntimeError, match="other values"):
            other.solver("pcs", start=checkpoint)


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
    with pytest.raises(drape.ConfigError, match="density"):
        again.set("material.density", -1)
    with pytest.raises(drape.ConfigError, match="cloth"):
        again.set("cloth.columns", 7)
    next(again)  # goes on as it was


def test_a_solve_may_be_left_at_any_time(experiment):
    for _ in range(20):
        next(experiment.solver("pcs"))
    gc.collect()
    never = experiment.solver("pcs")
    del never


def test_a_solve_that_is_left_at_exit_ends(small):
    script = f"""
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
import drape, prototypes
drape.register("springs", prototypes.Springs)
small = {small!r}
small["energies"][0] = "springs"
solver = drape.Experiment(small).solver("newton")
next(solver)
"""
    ended = subprocess.run([sys.executable, "-c", script], env={**os.environ, **PRELOADED}, capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_unknown_methods(experiment):
    with pytest.raises(RuntimeError, match="nothing_such"):
        experiment.solver("nothing_such")
    with pytest.raises(RuntimeError, match="one method"):
        experiment.solver("all")


def test_a_solve_is_of_one_thread_at_a_time(small):
    small["cloth"].update(columns=40, rows=40)
    solver = drape.Experiment(small).solver("newton")

    def advance(_):
        for _ in range(50):
            try:
                next(solver)
            except RuntimeError as error:
                assert "being advanced" in str(error)
            except StopIteration:
                return

    with ThreadPoolExecutor(2) as threads:
        list(threads.map(advance, range(2)))
