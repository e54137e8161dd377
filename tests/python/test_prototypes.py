"""Energies, metrics and refiners in Python."""

import gc

import numpy
import pytest
import scipy.sparse

import drape
import prototypes
from conftest import bits_of, own, run, statuses_of, with_membrane
from prototypes import NumpyStvk, Springs


@pytest.fixture(autouse=True)
def registered():
    for name, prototype in (("numpy_stvk", NumpyStvk), ("springs", Springs), ("height", prototypes.Height),
                            ("python_midpoint", prototypes.Midpoint), ("python_newton", prototypes.ProjectedNewton)):
        assert drape.register(name, prototype) is prototype


def deformed(level):
    stretch = numpy.array([[1.2, 0.1, 0.3], [-0.2, 0.9, 0.1], [0, 0, 1]])
    return level.rest @ stretch + 0.05 * numpy.random.default_rng(3).standard_normal(level.rest.shape)


def test_a_numpy_membrane_is_its_twin(scene):
    level, material = scene.levels[1], drape.Material()
    twin, numpys = (drape.bind_energy(energy, level, material) for energy in ("stvk", NumpyStvk()))
    x = deformed(level)
    assert numpys.value(x) == pytest.approx(twin.value(x), rel=1e-12)
    g, expected = numpys.gradient(x), twin.gradient(x)
    assert numpy.linalg.norm(g - expected) <= 1e-12 * numpy.linalg.norm(expected)
    h, expected = numpys.hessian(x), twin.hessian(x)
    assert abs(h - expected).max() <= 1e-12 * abs(expected).max()


@pytest.mark.parametrize("order", [
    numpy.ascontiguousarray, numpy.asfortranarray,
    lambda a: numpy.repeat(a, 2, axis=0)[::2], lambda a: numpy.broadcast_to(a, (4,) + a.shape)[1],
])
def test_what_a_prototype_returns_may_have_any_order_in_memory(scene, order):
    def reordered(function):
        return lambda self, x, rest: order(getattr(NumpyStvk, function)(self, x, rest))

    level = scene.levels[0]
    x, functions = deformed(level), ("value", "gradient", "hessian")
    ordered = drape.bind_energy(own(NumpyStvk, **{name: reordered(name) for name in functions})(), level)
    expected = drape.bind_energy(NumpyStvk(), level)
    assert ordered.value(x) == expected.value(x)
    assert (ordered.gradient(x) == expected.gradient(x)).all()
    assert (ordered.hessian(x) != expected.hessian(x)).nnz == 0


def test_positions_of_elements_are_read_only(scene):
    level = scene.levels[0]
    shifts = own(Springs, gradient=lambda self, x, rest: x.__iadd__(1))
    with pytest.raises(ValueError, match="read-only"):
        drape.bind_energy(shifts(), level).gradient(level.rest)


def springs_with(function, place, factor):
    """Springs of which one function has this factor on these of its numbers."""
    def answer(self, x, rest):
        numbers = getattr(Springs, function)(self, x, rest)
        numbers[place] *= factor
        return numbers

    return own(Springs, **{function: answer})()


@pytest.mark.parametrize("energy, says", [
    (springs_with("gradient", numpy.s_[0, 1, 2], 1.5), ""),
    (springs_with("hessian", numpy.s_[:, 3:, :3], 0), ""),
    (springs_with("hessian", numpy.s_[0, 1, 2], numpy.nan), "hessian: NOT FINITE at vertices "),
    (own(NumpyStvk, midpoint_factor=7)(), "midpoint_factor: error"),
    ({"type": "formula", "density": "100*(g11^2 + g22^2 + g12^2) + 5*abs(g11)"}, "NOT SMOOTH: the force jumps by "),
])
def test_check_energy_finds_what_is_wrong(capsys, energy, says):
    assert not drape.check_energy(energy)
    assert says in capsys.readouterr().out


def test_check_energy_passes_what_is_right(capsys):
    for energy in (NumpyStvk(), Springs(stiffness=3.0), "neo_hookean", "hinge"):
        assert drape.check_energy(energy)
    said = capsys.readouterr().out
    assert "gradient: largest error" in said and "midpoint_factor: error" in said
    square = drape.Level([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    tilted = square.rest @ [[1, 0, 0.3], [0, 1, 0.1], [0, 0, 1]]
    assert drape.check_energy("gravity", square, x=tilted)  # its energy is 0 up to round-off


def test_bending_keeps_coarse_membranes_of_pcs_from_buckling(small):
    energies = set()
    for stiffness in (0.0, 1e-3):
        drape.register("plate", own(Springs, role="bending", plate_stiffness=lambda self, material, d=stiffness: d))
        result = run({**small, "energies": ["neo_hookean", "plate", "gravity"]}, methods=["pcs"])
        energies.add(result["pcs"].levels[0].energy)
    assert len(energies) == 2


def test_a_coarse_level_says_that_its_membrane_does_not_buckle(small):
    said = "resist compression with all their stiffness on this level"
    for energies, told in ((["neo_hookean"], ""), (["numpy_stvk"], "the membrane numpy_stvk has no law for cloth that buckles below the mesh"),
                           (["neo_hookean", "stvk"], "the membranes neo_hookean, stvk " + said)):
        levels = run({**small, "energies": [*energies, "hinge", "gravity"]}, methods=["pcs"])["pcs"].levels
        assert levels[0].message.startswith(told) and bool(levels[0].message) == bool(told) and not levels[-1].message
    plain = {"pcs": {"membranes": "plain"}, "newton": {}}
    assert not run({**small, "energies": ["numpy_stvk", "hinge", "gravity"], "methods": plain}, methods=["pcs"])["pcs"].levels[0].message


def test_parameters_are_checked_like_a_plugins(small):
    small["energies"][0] = {"type": "springs", "stiffness": 20}
    assert drape.Experiment(small).resolved["energies"][0] == {"type": "springs", "stiffness": 20}
    for key, value in (("stiffness", -1), ("stiffness", "much"), ("stifness", 1)):
        small["energies"][0] = {"type": "springs", key: value}
        with pytest.raises(drape.ConfigError, match="stiffness"):
            drape.Experiment(small).check()
    assert dict(drape.plugins("energy"))["springs"] == "Springs along the edges."


def test_an_experiment_uses_prototypes_by_name(small):
    small.update(metrics=["height", "stretch"], refiner="python_midpoint",
                 methods={"newton": {}, "python_newton": {"tolerance": 1e-2}})
    small["energies"][0] = "numpy_stvk"
    result = run(small, methods=["all"])
    level = result["newton"].levels[1]
    assert level.lowest_z == level.x[:, 2].min()
    assert bits_of(run({**small, "refiner": "midpoint"}, methods=["newton"]), "newton") == bits_of(result, "newton")
    small["energies"][0] = "stvk"
    twin = run(small, methods=["newton"])["newton"].levels[1]
    assert level.energy == pytest.approx(twin.energy, rel=1e-5) and "numpy_stvk" in level.energy_parts
    solved = result["python_newton"]
    assert statuses_of(solved) == ["converged", "converged"]
    assert solved.levels[1].force_residual < 1e-2 and solved.levels[1].iterations > 0


def test_a_prototype_is_replaced_and_earlier_experiments_stay(small):
    small["energies"][0] = "springs"
    before = drape.Experiment(small).scene()
    drape.register("springs", own(Springs, value=lambda self, x, rest: 1 / 0))
    gc.collect()
    x = before.start(0)
    assert numpy.isfinite(before[0].energy(x))
    with pytest.raises(ZeroDivisionError):
        drape.Experiment(small).scene()[0].energy(x)
    with pytest.raises(RuntimeError, match="already registered"):
        drape.register("stvk", Springs)
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
    experiment = drape.Experiment(with_membrane(small, own(Springs, **{function: answer})))
    for method in ("pcs", "newton", "python_newton"):
        with pytest.raises(error):
            run(experiment, methods=[method])
        with pytest.raises(error):
            list(experiment.solver(method))


def test_elements_are_checked(small):
    for elements in ([[0, 36]], [[-1, 0]], [0, 1], numpy.zeros((3, 0), int), [[0.5, 1]]):
        with pytest.raises(drape.ConfigError, match="what Own.elements returns must"):
            drape.Experiment(with_membrane(small, own(Springs, elements=lambda self, level: elements))).check()


@pytest.mark.parametrize("none", [[], numpy.zeros((0, 2), int)])
def test_a_level_may_have_no_elements(small, none):
    seam = own(Springs, elements=lambda self, level: level.edges[:3] if level.index == 1 else none,
               rest=lambda self, level, material: Springs.rest(self, level, material)[:3])
    drape.register("seam", seam)
    small["energies"].append("seam")
    experiment = drape.Experiment(small)
    scene = experiment.scene()
    assert scene[0].energy_parts(scene.start(0))["seam"] == 0
    assert run(experiment)["pcs"].levels[-1].energy_parts["seam"] > 0
    bound, x = drape.bind_energy(seam(), scene.levels[0]), numpy.zeros((36, 3))
    assert not bound.gradient(x).any() and bound.hessian(x).count_nonzero() == 0


@pytest.mark.parametrize("attribute, value, error, message", [
    ("role", 7, TypeError, "Own.role must be membrane, .*, not 7"),
    ("role", "load", ValueError, "Own.role must be membrane, .*, not \"load\""),
    *(("midpoint_factor", value, error, "Own.midpoint_factor must be a finite number above 0, or None, not")
      for value, error in (("x", TypeError), (-1, ValueError), (0, ValueError), (numpy.nan, ValueError),
                           (numpy.inf, ValueError))),
])
def test_attributes_are_checked(scene, attribute, value, error, message):
    with pytest.raises(error, match=message):
        drape.bind_energy(own(Springs, **{attribute: value})(), scene.levels[0])


HEIGHT = {"height": drape.Column("m", "neither")}


@pytest.mark.parametrize("base, attribute, value, error, message", [
    (drape.Energy, "parameters", {"role": 1.0}, ValueError,
     'Own.parameters: "role" needs another name: drape.Energy has an attribute "role"'),
    (drape.Energy, "parameters", ["k"], TypeError, r"Own.parameters must be a dict .*, not \['k'\]"),
    (drape.Energy, "parameters", {1: 2.0}, TypeError, "Own.parameters: a name must be a str, not 1"),
    (drape.Energy, "parameters", {"k": [1]}, TypeError,
     r'Own.parameters\["k"\] must default to a bool, int, float or str, not \[1\]'),
    (drape.Energy, "parameters", {"k": drape.Parameter(1.0, unit=3)}, TypeError,
     r'Own.parameters\["k"\].unit must be a str, not 3'),
    (drape.Energy, "parameters", {"k": drape.Parameter(1.0, minimum="0")}, TypeError,
     r'Own.parameters\["k"\].minimum must be a number or None'),
    (drape.Energy, "parameters", {"k": drape.Parameter(-1.0, minimum=0)}, RuntimeError, "default of parameter"),
    (drape.Metric, "columns", {}, TypeError,
     "Own.columns must be a dict with a drape.Column for every value that measure returns"),
    (drape.Metric, "columns", ["height"], TypeError, r"Own.columns must be a dict .*, not \['height'\]"),
    (drape.Metric, "columns", {"height": "m"}, TypeError,
     "Own.columns: \"height\" must be a drape.Column, such as .*, not 'm'"),
    (drape.Metric, "columns", {1: drape.Column()}, TypeError, "Own.columns: a name must be a str, not 1"),
    (drape.Metric, "columns", {"height": drape.Column(label=1)}, TypeError,
     r'Own.columns\["height"\].label must be a str or None, not 1'),
    (drape.Metric, "columns", {"height": drape.Column(better="best")}, ValueError,
     r'Own.columns\["height"\].better must be lower, higher or neither'),
    (drape.Metric, "columns", {"status": drape.Column()}, ValueError,
     'the value "status" needs another name: results.json has a key "status" of its own'),
    (drape.Metric, "columns", {"largest_stretch": drape.Column()}, ValueError,
     'the value "largest_stretch" is declared by metric stretch too'),
    (drape.Metric, "scope", "pairs", ValueError, "Own.scope must be"),
    (drape.Metric, "scope", 1, TypeError, "Own.scope must be"),
])
def test_a_class_that_declares_something_else_is_refused_and_replaces_none(base, attribute, value, error, message):
    kind, name = ("energy", "springs") if base is drape.Energy else ("metric", "height")
    before = dict(drape.plugins(kind))
    with pytest.raises(error, match=message):
        drape.register(name, own(base, **{"columns": HEIGHT, attribute: value}))
    assert dict(drape.plugins(kind)) == before


@pytest.mark.parametrize("answer, error, message", [
    (lambda: {"hight": 1.0}, ValueError, "Own.measure returned \"hight\", which is not in Own.columns"),
    (lambda: 1.5, TypeError, "Own.measure must return a dict from the names in Own.columns to numbers, not 1.5"),
    (lambda: {"height": "far"}, TypeError, "Own.measure must return a number for \"height\", not 'far'"),
    (lambda: {"height": numpy.ones(36)}, TypeError, r"a number for \"height\", not an array of the shape \(36,\)"),
    (lambda: {"height": numpy.complex128(1)}, TypeError, "a number for \"height\""),
    (lambda: {}["lost"], KeyError, "lost"),
])
def test_a_metric_returns_the_numbers_that_it_declares(small, answer, error, message):
    # Experiments that name no metrics have this one too.
    drape.register("height", own(drape.Metric, parameters={"fails": False}, columns=HEIGHT,
                                 measure=lambda self, level, x, other: answer() if self.fails else {"height": 1.0}))
    with pytest.raises(error, match=message):
        run({**small, "metrics": [{"type": "height", "fails": True}]})


def test_a_refiner_returns_weights(small):
    small["refiner"] = "midpoint"
    scene = drape.Experiment(small).scene()
    small["refiner"] = "own"
    drape.register("own", own(drape.Refiner, weights=lambda self, level: scene.midpoints[level.index]))
    assert drape.Experiment(small).scene().levels[1].rest.tobytes() == scene.levels[1].rest.tobytes()
    for answer, message in (
            (scipy.sparse.identity(36), "a row for each vertex, then one for each edge"),
            *((other, "Own.weights must return a sparse .* matrix of real numbers, not")
              for other in (None, "all", numpy.ones((2, 2), complex), numpy.ones((2, 2, 2))))):
        drape.register("own", own(drape.Refiner, weights=lambda self, level: answer))
        with pytest.raises(drape.ConfigError, match=message):
            drape.Experiment(small).check()


def test_what_is_forgotten_is_named():
    with pytest.raises(TypeError, match="an energy is a drape.Energy object, .*; make an object of the class by calling it"):
        drape.check_energy(Springs)
    for base, function, arguments in (
            (drape.Energy, "elements", 1), (drape.Energy, "value", 2), (drape.Energy, "gradient", 2),
            (drape.Energy, "hessian", 2), (drape.Metric, "measure", 3), (drape.Refiner, "weights", 1),
            (drape.Solver, "solve", 1)):
        with pytest.raises(NotImplementedError, match=rf"Own must define {function}\(self, "):
            getattr(own(base)(), function)(*[None] * arguments)
