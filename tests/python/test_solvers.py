"""Solvers in Python, and what prototypes raise while others work."""

import subprocess
import sys

import numpy
import pytest

import drape
from conftest import own, run, solved_by, statuses_of, with_membrane
from prototypes import ProjectedNewton, Springs


def whole(problem, level):
    problem.begin(level)
    problem.iteration(problem.start(level))
    problem.end(problem.start(level))


def test_a_solver_steps_and_stops(small):
    experiment = drape.Experiment(solved_by(small, ProjectedNewton))
    solver = experiment.solver()
    first = next(solver)
    assert first.level == 0 and first.step == 1
    solver.stop()
    assert list(solver) == []
    assert statuses_of(solver) == ["cancelled"]
    again = experiment.solver()
    next(again)
    again.set("material.density", 900)  # the coarsest level begins again, from this state
    assert next(iteration for iteration in again if iteration.level == 1)
    with pytest.raises(RuntimeError, match="cannot go on from a state"):
        again.set("material.density", 800)


def test_a_solver_may_skip_levels_and_what_it_keeps_is_not_used_after_its_end(small):
    kept = []

    def solve(problem):
        kept.extend((problem, problem.model(0), problem.start(0)))
        whole(problem, 1)
        with pytest.raises(ValueError, match="level 0 cannot begin after level 1"):
            problem.begin(0)

    result = run(solved_by(small, solve))
    assert result.complete and [level.level for level in result["own_solver"].levels] == [1]
    problem, model, x = kept
    assert x.shape == (36, 3)
    for use in (lambda: problem.start(0), lambda: model.energy(x)):
        with pytest.raises(RuntimeError, match="has ended"):
            use()


def test_a_solver_reports_finite_states_of_levels_that_exist(small):
    def solve(problem):
        problem.begin(0)
        with pytest.raises(ValueError, match="finite"):
            problem.iteration(numpy.inf * problem.start(0))
        with pytest.raises(ValueError, match="finite"):
            problem.end(numpy.nan * problem.start(0))
        with pytest.raises(IndexError):
            problem.model(9)
        with pytest.raises(ValueError, match="saddle, max_steps_reached"):
            problem.end(problem.start(0), "lost")
        problem.end(problem.start(0), "saddle")
        with pytest.raises(IndexError):
            problem.begin(9)
        problem.begin(1)  # the level that does not exist has not begun
        problem.end(problem.start(1), "infeasible", "not tried")

    levels = run(solved_by(small, solve))["own_solver"].levels
    assert [(level.status, level.message) for level in levels] == [("saddle", ""), ("infeasible", "not tried")]


@pytest.mark.parametrize("told", [None, 0.0, 1.0])
def test_a_start_that_is_called_the_end_is_not_at_rest_whatever_residual_is_told(small, told):
    def solve(problem):
        for level in range(problem.level_count):
            problem.begin(level)
            if told is not None:
                problem.iteration(problem.start(level), force_residual=told)
            problem.end(problem.start(level), "converged")

    finest = run(solved_by(small, solve))["own_solver"].levels[-1]
    assert finest.status == "stalled"
    assert finest.message.startswith("the method says that it converged; the force residual is ")


@pytest.mark.parametrize("solve, error", [
    (lambda problem: None, "has ended no level"),
    (lambda problem: problem.begin(0), "has not ended level 0"),
    (lambda problem: [whole(problem, level) for level in (1, 0)], "level 0 cannot begin after level 1"),
    (lambda problem: [whole(problem, level) for level in (0, 0)], "level 0 cannot begin after level 0"),
])
def test_a_solver_reports_every_level_once_from_coarse_to_fine(small, solve, error):
    experiment = drape.Experiment(solved_by(small, solve))
    for use in (run, lambda experiment: list(experiment.solver())):
        with pytest.raises(ValueError, match=error):
            use(experiment)


def test_the_end_of_a_level_has_the_plain_models_residual(small):
    given = 0.125

    def solve(problem):
        for level, lift in enumerate((0.01, 0)):
            problem.begin(level)
            x = problem.start(level)
            if level == 1:
                problem.iteration(x, force_residual=given)
            problem.end(x + [0, 0, lift], "stalled")

    small.update(contact="shapes", obstacles=[{"shape": "sphere", "radius": 0.1, "translate": [0.5, 0.5, -0.1005]}])
    experiment = drape.Experiment(solved_by(small, solve))
    levels, scene = run(experiment)["own_solver"].levels, experiment.scene()
    assert levels[0].force_residual == pytest.approx(scene[0].force_residual(levels[0].x), rel=1e-12) != 0
    assert levels[1].force_residual == given
    assert levels[1].smallest_gap == scene[1].contacts(levels[1].x)[0]["smallest_gap"]


def test_what_python_handles_is_not_raised(small):
    def value(self, x, rest):
        return 1 / 0 if numpy.isnan(x).any() else Springs.value(self, x, rest)

    def ask_of(model, start):
        with pytest.raises(ZeroDivisionError):
            model.energy(numpy.nan * start)

    def solve(problem):
        ask_of(problem.model(0), problem.start(0))
        whole(problem, 0)

    experiment = drape.Experiment(solved_by(with_membrane(small, own(Springs, value=value)), solve))
    model, start = experiment.scene()[0], experiment.scene().start(0)
    assert run(experiment, on_iteration=lambda i: ask_of(model, start)).complete


def test_a_run_in_a_callback_raises_what_its_prototypes_raise(small):
    class Late(Springs):  # not while its scene is built
        failing = False

        def gradient(self, x, rest):
            if Late.failing:
                raise ArithmeticError("too late")
            return super().gradient(x, rest)

    inner, seen = drape.Experiment(with_membrane(small, Late)), []
    inner.scene()

    def ask(level):
        Late.failing = True
        with pytest.raises(ArithmeticError, match="too late"):
            run(inner)
        seen.append(level)

    run(small, on_level=ask)
    assert seen


def test_a_run_with_a_method_that_failed_is_read_and_drawn(small, tmp_path):
    pytest.importorskip("matplotlib")
    drape.register("failing", own(drape.Solver, solve=lambda self, problem: 1 / 0))
    experiment = drape.Experiment({**small, "methods": {"newton": {}, "failing": {}}, "reference": "newton"})
    with pytest.raises(ZeroDivisionError):
        run(experiment, methods=["newton", "failing"], out=tmp_path / "out")
    result = drape.read_run(tmp_path / "out")
    assert result["newton"].levels[-1].x.shape[1] == 3
    with pytest.raises(RuntimeError, match="stored no state"):
        result["failing"].levels[-1].x
    assert result._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ZeroDivisionError):
        run(experiment, methods=["failing"], out=tmp_path / "first", report=False)
    assert drape.read_run(tmp_path / "first")._repr_png_() is None
    subprocess.run([sys.executable, "-m", "drape.paper", tmp_path / "out", "-o", tmp_path / "figures"], check=True)
    assert (tmp_path / "figures/newton_end.png").exists()
