"""Energies, metrics, refiners and solvers in Python."""

import gc
import subprocess
import sys

import numpy
import pytest
import scipy.sparse

import drape
import prototypes
from conftest import solved_by, with_membrane


@pytest.fixture(autouse=True)
def registered():
    for name, prototype in (("numpy_stvk", prototypes.NumpyStvk), ("springs", prototypes.Springs),
                            ("height", prototypes.Height), ("python_midpoint", prototypes.Midpoint),
                            ("python_newton", prototypes.ProjectedNewton)):
        assert drape.register(name, prototype) is prototype


def deformed(level, size=0.05):
    rng = numpy.random.default_rng(3)
    return level.rest @ numpy.array([[1.2, 0.1, 0.3], [-0.2, 0.9, 0.1], [0, 0, 1]]) + size * \
        rng.standard_normal(level.rest.shape)


def test_a_numpy_membrane_is_its_twin(scene):
    level = scene.levels[1]
    material = drape.Material()
    twin = drape.bind_energy("stvk", level, material)
    own = drape.bind_energy(prototypes.NumpyStvk(), level, material)
    x = deformed(level)
    assert own.value(x) == pytest.approx(twin.value(x), rel=1e-12)
    g, expected = own.gradient(x), twin.gradient(x)
    assert numpy.linalg.norm(g - expected) <= 1e-12 * numpy.linalg.norm(expected)
    h, expected = own.hessian(x), twin.hessian(x)
    assert abs(h - expected).max() <= 1e-12 * abs(expected).max()


@pytest.mark.parametrize("order", [
    numpy.ascontiguousarray, numpy.asfortranarray,
    lambda a: numpy.repeat(a, 2, axis=0)[::2], lambda a: numpy.broadcast_to(a, (4,) + a.shape)[1],
])
def test_what_a_prototype_returns_may_have_any_order_in_memory(scene, order):
    level = scene.levels[0]

    class Reordered(prototypes.NumpyStvk):
        def value(self, x, rest):
            return order(super().value(x, rest))

        def gradient(self, x, rest):
            return order(super().gradient(x, rest))

        def hessian(self, x, rest):
            return order(super().hessian(x, rest))

    x = deformed(level)
    own, expected = drape.bind_energy(Reordered(), level), drape.bind_energy(prototypes.NumpyStvk(), level)
    assert own.value(x) == expected.value(x)
    assert (own.gradient(x) == expected.gradient(x)).all()
    assert (own.hessian(x) != expected.hessian(x)).nnz == 0


def test_positions_of_elements_are_read_only(scene):
    class Shifts(prototypes.Springs):
        def gradient(self, x, rest):
            x += 1
            return super().gradient(x, rest)

    level = scene.levels[0]
    with pytest.raises(ValueError, match="read-only"):
        drape.bind_energy(Shifts(), level).gradient(level.rest)


def test_check_energy(capsys):
    assert drape.check_energy(prototypes.NumpyStvk())
    assert drape.check_energy(prototypes.Springs(stiffness=3.0))
    assert drape.check_energy("neo_hookean")
    assert "gradient: largest error" in capsys.readouterr().out

    class Wrong(prototypes.Springs):
        def gradient(self, x, rest):
            g = super().gradient(x, rest)
            g[0, 1, 2] *= 1.5
            return g

    assert not drape.check_energy(Wrong())

    class Broken(prototypes.Springs):
        def hessian(self, x, rest):
            h = super().hessian(x, rest)
            h[0, 1, 2] = numpy.nan
            return h

    class OneSided(prototypes.Springs):
        def hessian(self, x, rest):
            h = super().hessian(x, rest)
            h[:, 3:, :3] = 0
            return h

    assert not drape.check_energy(OneSided())
    assert not drape.check_energy(Broken())
    assert "hessian: NOT FINITE at vertices " in capsys.readouterr().out
    assert not drape.check_energy({"type": "formula", "density": "100*(g11^2 + g22^2 + g12^2) + 5*abs(g11)"})
    assert "NOT SMOOTH: the force jumps by " in capsys.readouterr().out


def test_an_experiment_uses_a_prototype_by_name(small):
    results = {}
    for membrane in ("stvk", "numpy_stvk"):
        small["energies"][0] = membrane
        results[membrane] = drape.Experiment(small).run(methods=["pcs", "newton"], progress=False)
    for method in ("pcs", "newton"):
        own, twin = (results[name][method] for name in ("numpy_stvk", "stvk"))
        assert [level.status for level in own.levels] == [level.status for level in twin.levels]
        assert own.levels[-1].energy == pytest.approx(twin.levels[-1].energy, rel=1e-5)
        assert "numpy_stvk" in own.levels[-1].energy_parts


def test_bending_keeps_coarse_membranes_of_pcs_from_buckling(small):
    energies = set()
    for stiffness in (0.0, 1e-3):
        class Plate(prototypes.Springs):
            role = "bending"

            def plate_stiffness(self, material, stiffness=stiffness):
                return stiffness

        drape.register("plate", Plate)
        result = drape.Experiment({**small, "energies": ["neo_hookean", "plate", "gravity"]}).run(methods=["pcs"], progress=False)
        energies.add(result["pcs"].levels[0].energy)
    assert len(energies) == 2


def test_parameters_are_checked_like_a_plugins(small):
    small["energies"][0] = {"type": "springs", "stiffness": 20}
    experiment = drape.Experiment(small)
    assert experiment.resolved["energies"][0] == {"type": "springs", "stiffness": 20}
    for key, value in (("stiffness", -1), ("stiffness", "much"), ("stifness", 1)):
        small["energies"][0] = {"type": "springs", key: value}
        with pytest.raises(drape.ConfigError, match="stiffness"):
            drape.Experiment(small).check()
    assert "springs" in dict(drape.plugins("energy"))
    assert dict(drape.plugins("energy"))["springs"] == "Springs along the edges."


def test_metrics_refiners_and_solvers(small):
    small["metrics"] = ["height", "stretch"]
    small["refiner"] = "python_midpoint"
    small["methods"] = {"newton": {}, "python_newton": {"tolerance": 1e-2}}
    result = drape.Experiment(small).run(methods=["all"], progress=False)
    x = result["newton"].levels[1].x
    assert result["newton"].levels[1].lowest_z == x[:, 2].min()
    small["refiner"] = "midpoint"
    same = drape.Experiment(small).run(methods=["newton"], progress=False)
    assert same["newton"].levels[1].x.tobytes() == x.tobytes()
    own = result["python_newton"]
    assert [level.status for level in own.levels] == ["converged", "converged"]
    assert own.levels[1].force_residual < 1e-2
    assert own.levels[1].iterations > 0


def test_a_solver_steps_and_stops(small):
    experiment = drape.Experiment(solved_by(small, prototypes.ProjectedNewton))
    solver = experiment.solver()
    first = next(solver)
    assert first.level == 0 and first.step == 1
    solver.stop()
    assert list(solver) == []
    assert solver.levels[0].status == "cancelled"
    again = experiment.solver()
    next(again)
    again.set("material.density", 900)  # the coarsest level begins anew, from this state
    assert next(iteration for iteration in again if iteration.level == 1)
    with pytest.raises(RuntimeError, match="cannot go on from a state"):
        again.set("material.density", 800)


def test_a_prototype_is_replaced_and_earlier_experiments_stay(small):
    class Unlucky(prototypes.Springs):
        def value(self, x, rest):
            raise ArithmeticError("out of luck")

    small["energies"][0] = "springs"
    before = drape.Experiment(small).scene()
    drape.register("springs", Unlucky)
    gc.collect()
    x = before.start(0)
    assert numpy.isfinite(before[0].energy(x))
    with pytest.raises(ArithmeticError, match="out of luck"):
        drape.Experiment(small).scene()[0].energy(x)
    with pytest.raises(RuntimeError, match="already registered"):
        drape.register("stvk", prototypes.Springs)
    with pytest.raises(TypeError, match="not a class derived"):
        drape.register("dict", dict)


@pytest.mark.parametrize("function, answer, error", [
    ("value", lambda self, x, rest: 1 / 0, ZeroDivisionError),
    ("hessian", lambda self, x, rest: 1 / 0, ZeroDivisionError),
    ("gradient", lambda self, x, rest: x[:-1], ValueError),
    ("hessian", lambda self, x, rest: numpy.zeros((len(x), 3, 3)), ValueError),
    ("value", lambda self, x, rest: ["a"] * len(x), TypeError),
    ("value", lambda self, x, rest: None, TypeError),
])
def test_what_a_prototype_raises_is_raised(small, function, answer, error):
    small["methods"]["python_newton"] = {}  # through a solver in Python it keeps its type
    experiment = drape.Experiment(with_membrane(small, type("Bad", (prototypes.Springs,), {function: answer})))
    for method in ("pcs", "newton", "python_newton"):
        with pytest.raises(error):
            experiment.run(methods=[method], progress=False)
        with pytest.raises(error):
            list(experiment.solver(method))


def test_elements_are_checked(small):
    for elements in ([[0, 36]], [[-1, 0]], [0, 1], numpy.zeros((3, 0), int), [[0.5, 1]]):
        bad = type("Bad", (prototypes.Springs,), {"elements": lambda self, level: elements})
        with pytest.raises(drape.ConfigError, match="what Bad.elements returns must"):
            drape.Experiment(with_membrane(small, bad)).check()


@pytest.mark.parametrize("none", [[], numpy.zeros((0, 2), int)])
def test_a_level_may_have_no_elements(small, none):
    class Seam(prototypes.Springs):
        def elements(self, level):
            return level.edges[:3] if level.index == 1 else none

        def rest(self, level, material):
            return super().rest(level, material)[:3]

    drape.register("seam", Seam)
    small["energies"].append("seam")
    experiment = drape.Experiment(small)
    assert experiment.scene()[0].energy_parts(experiment.scene().start(0))["seam"] == 0
    assert experiment.run(progress=False)["pcs"].levels[-1].energy_parts["seam"] > 0
    bound = drape.bind_energy(Seam(), experiment.scene().levels[0])
    assert not bound.gradient(numpy.zeros((36, 3))).any() and bound.hessian(numpy.zeros((36, 3))).count_nonzero() == 0


@pytest.mark.parametrize("attribute, value, error, message", [
    ("role", 7, TypeError, "Faulty.role must be membrane, .*, not 7"),
    ("role", "load", ValueError, "Faulty.role must be membrane, .*, not \"load\""),
    *(("midpoint_factor", value, error, "Faulty.midpoint_factor must be a finite number above 0, or None, not")
      for value, error in (("x", TypeError), (-1, ValueError), (0, ValueError), (numpy.nan, ValueError),
                           (numpy.inf, ValueError))),
])
def test_attributes_are_checked(scene, attribute, value, error, message):
    with pytest.raises(error, match=message):
        drape.bind_energy(type("Faulty", (prototypes.Springs,), {attribute: value})(), scene.levels[0])


@pytest.mark.parametrize("parameters, error, message", [
    ({"role": 1.0}, ValueError, "Faulty.parameters: \"role\" needs another name: drape.Energy has an attribute \"role\""),
    (["k"], TypeError, r"Faulty.parameters must be a dict .*, not \['k'\]"),
    ({1: 2.0}, TypeError, "Faulty.parameters: a name must be a str, not 1"),
    ({"k": [1]}, TypeError, r'Faulty.parameters\["k"\] must default to a bool, int, float or str, not \[1\]'),
    ({"k": drape.Parameter(1.0, unit=3)}, TypeError, r'Faulty.parameters\["k"\].unit must be a str, not 3'),
    ({"k": drape.Parameter(1.0, minimum="0")}, TypeError, r'Faulty.parameters\["k"\].minimum must be a number or None'),
])
def test_parameters_are_declared_properly(parameters, error, message):
    with pytest.raises(error, match=message):
        drape.register("faulty", type("Faulty", (drape.Energy,), {"parameters": parameters}))


def test_what_is_forgotten_is_named(scene):
    with pytest.raises(TypeError, match="an energy is a drape.Energy object, .*; make an object of the class by calling it"):
        drape.check_energy(prototypes.Springs)
    for kind, method in ((drape.Energy, "elements(scene.levels[0])"), (drape.Energy, "value(None, None)"),
                         (drape.Energy, "gradient(None, None)"), (drape.Energy, "hessian(None, None)"),
                         (drape.Metric, "measure(None, None, None)"), (drape.Refiner, "weights(None)"),
                         (drape.Solver, "solve(None)")):
        with pytest.raises(NotImplementedError, match=rf"Empty must define {method.split('(')[0]}\(self, "):
            eval("empty." + method, {"empty": type("Empty", (kind,), {})(), "scene": scene})


def test_a_class_that_is_refused_replaces_none():
    faulty = type("Faulty", (prototypes.Springs,), {"parameters": {"stiffness": drape.Parameter(-1.0, minimum=0)}})
    with pytest.raises(RuntimeError, match="default of parameter"):
        drape.register("springs", faulty)
    assert "springs" in dict(drape.plugins("energy"))


def test_a_refiner_may_return_a_scenes_matrix(small):
    small["refiner"] = "midpoint"
    scene = drape.Experiment(small).scene()
    drape.register("same", type("Same", (drape.Refiner,), {"weights": lambda self, level: scene.midpoints[level.index]}))
    same = drape.Experiment({**small, "refiner": "same"}).scene()
    assert same.levels[1].rest.tobytes() == scene.levels[1].rest.tobytes()


def test_a_midpoint_factor_is_checked(capsys):
    assert drape.check_energy("hinge") and drape.check_energy(prototypes.NumpyStvk())
    assert "midpoint_factor: error" in capsys.readouterr().out
    assert not drape.check_energy(type("Seven", (prototypes.NumpyStvk,), {"midpoint_factor": 7})())
    square = drape.Level([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    tilted = square.rest @ [[1, 0, 0.3], [0, 1, 0.1], [0, 0, 1]]
    assert drape.check_energy("gravity", square, x=tilted)  # its energy is 0 up to round-off


def test_a_metric_or_refiner_that_fails(small):
    class Broken(drape.Metric):
        parameters = {"fails": False}  # experiments that name no metrics have this one too
        columns = {"a": drape.Column()}

        def measure(self, level, x, other):
            if self.fails:
                raise KeyError("lost")
            return {"a": 1.0}

    class Thin(drape.Refiner):
        def weights(self, level):
            return scipy.sparse.identity(level.vertex_count)

    drape.register("broken", Broken)
    drape.register("thin", Thin)
    with pytest.raises(KeyError, match="lost"):
        drape.Experiment({**small, "metrics": [{"type": "broken", "fails": True}]}).run(progress=False)
    with pytest.raises(drape.ConfigError, match="a row for each vertex, then one for each edge"):
        drape.Experiment({**small, "refiner": "thin"}).check()
    for answer in (None, "all", numpy.ones((2, 2), complex), numpy.ones((2, 2, 2))):
        drape.register("thin", type("Thin", (drape.Refiner,), {"weights": lambda self, level: answer}))
        with pytest.raises(drape.ConfigError, match="Thin.weights must return a sparse .* matrix of real numbers, not"):
            drape.Experiment({**small, "refiner": "thin"}).check()


def test_what_a_solver_keeps_is_not_used_after_its_end(small):
    kept = []

    class Keeps(prototypes.ProjectedNewton):
        def solve(self, problem):
            kept.append((problem, problem.model(0), problem.start(0)))
            super().solve(problem)

    drape.Experiment(solved_by(small, Keeps)).run(progress=False)
    problem, model, x = kept[0]
    assert x.shape == (36, 3)
    with pytest.raises(RuntimeError, match="has ended"):
        problem.start(0)
    with pytest.raises(RuntimeError, match="has ended"):
        model.energy(x)


def test_a_solver_reports_finite_states(small):
    class Lost(drape.Solver):
        def solve(self, problem):
            problem.begin(0)
            with pytest.raises(ValueError, match="finite"):
                problem.iteration(numpy.inf * problem.start(0))
            with pytest.raises(ValueError, match="finite"):
                problem.end(numpy.nan * problem.start(0))
            with pytest.raises(IndexError):
                problem.model(9)
            problem.end(problem.start(0), "stalled")
            with pytest.raises(IndexError):
                problem.begin(9)
            problem.begin(1)  # the level that does not exist has not begun
            problem.end(problem.start(1), "infeasible", "not tried")

    result = drape.Experiment(solved_by(small, Lost)).run(progress=False)
    assert [(level.status, level.message) for level in result["own_solver"].levels] == [
        ("stalled", ""), ("infeasible", "not tried")]


@pytest.mark.parametrize("solve, error", [
    (lambda problem: None, "has ended no level"),
    (lambda problem: problem.begin(0), "has not ended level 0"),
    (lambda problem: [whole(problem, level) for level in (1, 0)], "level 0 cannot begin after level 1"),
    (lambda problem: [whole(problem, level) for level in (0, 0)], "level 0 cannot begin after level 0"),
])
def test_a_solver_reports_every_level_once_from_coarse_to_fine(small, solve, error):
    careless = type("Careless", (drape.Solver,), {"solve": lambda self, problem: solve(problem)})
    experiment = drape.Experiment(solved_by(small, careless))
    with pytest.raises(ValueError, match=error):
        experiment.run(progress=False)
    with pytest.raises(ValueError, match=error):
        list(experiment.solver())


def whole(problem, level):
    problem.begin(level)
    problem.iteration(problem.start(level))
    problem.end(problem.start(level))


def test_the_end_of_a_level_has_the_plain_models_residual(small):
    given = 0.125

    class Ends(drape.Solver):
        def solve(self, problem):
            for level, ends_where_it_was in enumerate((False, True)):
                problem.begin(level)
                x = problem.start(level)
                if level == 1:
                    problem.iteration(x, force_residual=given)
                problem.end(x if ends_where_it_was else x + [0, 0, 0.01], "stalled")

    small.update(contact="shapes", obstacles=[{"shape": "sphere", "radius": 0.1, "translate": [0.5, 0.5, -0.1005]}])
    experiment = drape.Experiment(solved_by(small, Ends))
    levels = experiment.run(progress=False)["own_solver"].levels
    model = experiment.scene()[0]
    assert levels[0].force_residual == pytest.approx(model.force_residual(levels[0].x), rel=1e-12) != 0
    assert levels[1].force_residual == given
    assert levels[1].smallest_gap == experiment.scene()[1].contacts(levels[1].x)[0]["smallest_gap"]


def test_a_solver_may_skip_levels_and_recover(small):
    class Skips(drape.Solver):
        def solve(self, problem):
            whole(problem, 1)
            with pytest.raises(ValueError, match="level 0 cannot begin after level 1"):
                problem.begin(0)

    result = drape.Experiment(solved_by(small, Skips)).run(progress=False)
    assert result.complete and [level.level for level in result["own_solver"].levels] == [1]


def test_what_python_handles_is_not_raised(small):
    class Picky(prototypes.Springs):
        def value(self, x, rest):
            if numpy.isnan(x).any():
                raise ArithmeticError("not a number")
            return super().value(x, rest)

    class Careful(prototypes.ProjectedNewton):
        def solve(self, problem):
            with pytest.raises(ArithmeticError):
                problem.model(0).energy(numpy.nan * problem.start(0))
            super().solve(problem)

    experiment = drape.Experiment(solved_by(with_membrane(small, Picky), Careful))
    model, start = experiment.scene()[0], experiment.scene().start(0)

    def ask(iteration):
        with pytest.raises(ArithmeticError):
            model.energy(numpy.nan * start)

    assert experiment.run(on_iteration=ask, progress=False).complete


def test_a_run_in_a_callback_raises_what_its_prototypes_raise(small):
    class Late(prototypes.Springs):  # not while its scene is built
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
            inner.run(progress=False)
        seen.append(level)

    drape.Experiment(small).run(on_level=ask, progress=False)
    assert seen


def test_a_run_with_a_method_that_failed_is_read_and_drawn(small, tmp_path):
    pytest.importorskip("matplotlib")

    class Failing(prototypes.ProjectedNewton):
        def solve(self, problem):
            raise ArithmeticError("at once")

    drape.register("failing", Failing)
    experiment = drape.Experiment({**small, "methods": {"newton": {}, "failing": {}}, "reference": "newton"})
    with pytest.raises(ArithmeticError, match="at once"):
        experiment.run(methods=["newton", "failing"], out=tmp_path / "out", progress=False)
    result = drape.read_run(tmp_path / "out")
    assert result["newton"].levels[-1].x.shape[1] == 3
    with pytest.raises(RuntimeError, match="stored no state"):
        result["failing"].levels[-1].x
    assert result._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ArithmeticError, match="at once"):
        experiment.run(methods=["failing"], out=tmp_path / "first", report=False, progress=False)
    assert drape.read_run(tmp_path / "first")._repr_png_() is None
    ended = subprocess.run([sys.executable, "-m", "drape.figures", tmp_path / "out", "-o", tmp_path / "figures"])
    assert ended.returncode == 0 and (tmp_path / "figures/newton_end.png").exists()
