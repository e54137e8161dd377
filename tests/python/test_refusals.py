"""What an experiment refuses, and where it says the faults are."""

import decimal
import fractions
import json
import pathlib
import pickle

import numpy
import pytest

import drape
from conftest import run

ENDLESS = {"name": "a"}
ENDLESS["material"] = ENDLESS


def faults_of(source):
    with pytest.raises(drape.ConfigError) as raised:
        drape.Experiment(source).check()
    return raised.value.faults, str(raised.value)


def test_every_fault_is_listed_with_its_place(small, tmp_path):
    file = tmp_path / "faulty.yaml"
    file.write_text("name: faulty\nlevls: 2\nmaterial: {density: -1}\nenergies: [gravity]\nmethods: {pcs: {}}\n")
    faults, text = faults_of(file)
    assert [(f.file, f.line, f.key) for f in faults] == [(str(file), 2, "levls"), (str(file), 3, "material.density")]
    assert faults[0].column == 1 and "levels" in faults[0].message and "density" in faults[1].message
    assert text.count("\n") == 1
    with pytest.raises(drape.ConfigError):
        run(drape.Experiment(file))
    # A dict's have no place but their key.
    small.update(contact="shapes", obstacles=[{"shape": "sphere", "radius": -1}], levls=2)
    faults, text = faults_of(small)
    assert {(f.file, f.line, f.key) for f in faults} == {("", 0, "levls"), ("", 0, "obstacles.0.radius")}
    assert "obstacles.0.radius: " in text


def test_check_warns_and_finds_an_energy_that_is_not_finite(small):
    small["start"] = {"scale": [0, 0, 1], "perturbation": 1e-3}
    with pytest.warns(UserWarning), pytest.raises(drape.ConfigError, match="energy neo_hookean is not"):
        drape.Experiment(small).check()


@pytest.mark.parametrize("source, error, message", [
    ("none.yaml", drape.ConfigError, ""), (7, TypeError, "a YAML file or a dict"),
    ({"name": object()}, TypeError, "cannot hold"), ({"name": "\ud800"}, ValueError, "is no text that UTF-8 can hold"),
    (ENDLESS, ValueError, "too deeply"),
])
def test_what_is_no_experiment_is_refused(source, error, message):
    with pytest.raises(error, match=message):
        drape.Experiment(source)


@pytest.mark.parametrize("key, value", [
    ("material.thicknes", 1), ("material.thickness", -1), ("material.thickness", "thick"),
    ("material", {"thicknes": 1}), ("energies.0", "nothing_such"), ("pins.9.point", [0, 0, 0]),
])
def test_a_faulty_value_is_refused_where_it_is_set(experiment, key, value):
    before = experiment.resolved
    with pytest.raises(drape.ConfigError, match=f"--set {key}: "):
        experiment.set(key, value)
    assert experiment.resolved == before


def test_values_that_need_each_other_are_set_one_after_another(experiment):
    experiment.set("methods", {"pcs": {}})  # the reference is the method newton
    with pytest.raises(drape.ConfigError, match="reference"):
        experiment.check()
    experiment.set("reference", "pcs")
    experiment.check()


@pytest.mark.parametrize("key", ["energies.gravity.acceleration", "energies.2.acceleration"])
def test_what_a_schedule_sets_is_refused(small, key):
    small["energies"][2] = {"type": "gravity", "acceleration": [0, 0, -9.81]}
    small["schedule"] = {"keys": [{"parameter": "energies.gravity.acceleration", "times": [0, 1],
                                   "values": [[0, 0, -5], [0, 0, -9.81]]}]}
    with pytest.raises(drape.ConfigError, match="a schedule sets it"):
        drape.Experiment(small).set(key, [0, 0, -1])


@pytest.mark.parametrize("call, error, message", [
    (lambda experiment: run(experiment, methods=["nothing_such"]), RuntimeError, "nothing_such"),
    (lambda experiment: run(experiment, on_iteration=7), TypeError, "on_iteration must be a function"),
    (lambda experiment: run(experiment, on_iteration=lambda i: "on"), ValueError, "must return None"),
    (lambda experiment: experiment.solver("nothing_such"), RuntimeError, "nothing_such"),
    (lambda experiment: experiment.solver("all"), RuntimeError, "one method"),
    (lambda _: drape.plugins("enrgy"), ValueError, 'no kind "enrgy"'),
    (lambda _: drape.set_threads(-3), ValueError, "at least 0"),
    (lambda _: drape.set_threads(10**9), ValueError, "at most 1024"),
    *((lambda e, of=of: of(e, value), TypeError, "incompatible function arguments")
      for value in (numpy.float32(1.5), fractions.Fraction(3, 2), decimal.Decimal("1.5"), numpy.array(1.5))
      for of in (lambda _, v: drape.set_threads(v), lambda e, v: e.scene()[v], lambda e, v: e.scene().start(v),
                 lambda e, v: e.scene().prolong("newton", v, e.scene().start(0)),
                 lambda e, v: e.scene().metric("energy", v, e.scene().start(0)))),
    (lambda _: drape.Experiment({"name": "cut"}, mesh=(numpy.eye(3), [[0, 1, 2.7]])), TypeError, "must be integers, not float64"),
    (lambda _: drape.Material(densty=300), drape.ConfigError, 'did you mean "density"'),
    (lambda _: drape.Material(density=-1), drape.ConfigError, "density: "),
    (lambda _: drape.Level(numpy.eye(3), [[0, 1, 3]]), ValueError, ""),
    (lambda _: drape.Level([[0, 0, 0]], [0, 1, 2]), ValueError, "shape"),
    (lambda _: drape.Level(numpy.eye(3), [[0.0, 1.0, 2.0]]), TypeError, "integers"),
    (lambda e: drape.bind_energy("hinge", None), TypeError, "incompatible function arguments"),
])
def test_what_the_module_cannot_use_is_refused(experiment, call, error, message):
    with pytest.raises(error, match=message):
        call(experiment)


def test_what_the_module_can_use():
    assert drape.Material(density=300).density == 300
    level = drape.Level(numpy.eye(3), [[0, 1, 2]])
    assert level.edges.shape == (3, 2) and level.hinges.shape == (0, 4)
    for count in (2, numpy.int64(1), 0):
        drape.set_threads(count)


def test_a_state_whose_file_is_damaged_or_elsewhere_is_refused(small, tmp_path):
    folder = tmp_path / "r"
    mesh = folder / run(small, methods=["pcs"], out=folder, report=False)["pcs"].levels[-1].mesh
    whole = mesh.read_bytes()
    place = whole.index(b"end_header\n") + 20  # in a coordinate
    mesh.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1:])
    level = drape.read_run(folder)["pcs"].levels[-1]
    for use in (lambda: level.x, lambda: level.triangles, lambda: drape.read_run(folder)._repr_png_()):
        with pytest.raises(RuntimeError, match="pcs_l1.ply: is damaged: its checksum does not fit"):
            use()
    assert "pcs_l1.ply: is damaged" in drape.read_run(folder).page.text
    mesh.write_bytes(whole)
    assert numpy.isfinite(drape.read_run(folder)["pcs"].levels[-1].x).all()
    mesh.rename(tmp_path / "elsewhere.ply")
    for name in ("../elsewhere.ply", str(tmp_path / "elsewhere.ply")):
        results = json.loads((folder / "results.json").read_text())
        results["methods"]["pcs"]["levels"][-1]["mesh"] = name
        (folder / "results.json").write_text(json.dumps(results))
        with pytest.raises(RuntimeError, match="leads out of the folder"):
            drape.read_run(folder)["pcs"].levels[-1].x


@pytest.mark.parametrize("call", [
    lambda path: drape.Experiment(path),
    lambda path: drape.Experiment(pathlib.Path(path)),
    lambda path: drape.Result(path),
    lambda path: drape.resume(path),
    lambda path: drape.read_run(path),
])
def test_a_path_with_a_nul_character_is_refused(call):
    with pytest.raises((ValueError, RuntimeError), match="NUL|null byte"):
        call("a\0b")


@pytest.mark.parametrize("call", [
    lambda e: e.run(methods="p\0", out="unused"),
    lambda e: e.solver("p\0"),
    lambda e: e.set("levels\0", 1),
    lambda e: e.scene().metric("flat\0", 0, e.scene().start(0)),
    lambda e: drape.plugins("energy\0"),
])
def test_a_name_with_a_nul_character_is_refused_whole(experiment, call):
    with pytest.raises(ValueError, match="\\\\x00' has a NUL character; take it out"):
        call(experiment)


def test_an_object_whose_init_has_not_run_is_refused(small):
    classes = [value for value in vars(drape._core).values() if isinstance(value, type) and value.__module__ == "drape._core"
               and not issubclass(value, BaseException)]
    assert len(classes) > 8
    called = 0
    for made in classes:
        half = made.__new__(made)
        for name, attribute in vars(made).items():
            if isinstance(attribute, property):
                with pytest.raises((TypeError, RuntimeError)):
                    getattr(half, name)
                called += 1
            elif callable(attribute) and name not in ("__init__", "__new__", "__iter__") and not name.startswith("_pybind"):
                with pytest.raises((TypeError, RuntimeError)):
                    attribute(half)
                called += 1
    assert called > 50
    with pytest.raises(TypeError, match="__init__ has not run"):
        drape.Experiment.__new__(drape.Experiment).check()
    model = drape.Experiment(small).scene()[0]
    with pytest.raises(TypeError, match="__init__ has not run"):
        type(model).__new__(type(model)).level
    assert model.level.vertex_count > 0
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):  # pybind11 would end the process at 0 and 1
        with pytest.raises(TypeError, match="pickle"):
            pickle.dumps(model.level, protocol)
