"""The model under an experiment: derivatives, prolongations, metrics."""

import gc

import numpy
import pytest
import scipy.sparse

import drape
from conftest import run

CONTACT = {
    "name": "contact",
    "cloth": {"shape": "square", "side": 0.4, "columns": 7, "rows": 7},
    "levels": 1,
    "start": {"translate": [-0.2, -0.2, 0.1005]},
    "energies": ["stvk", "hinge", {"type": "strain_limit", "limit": 1.1}, "gravity"],
    "contact": {"type": "shapes", "dhat": 2e-3},
    "obstacles": [{"name": "ball", "shape": "sphere", "radius": 0.1}],
    "methods": {"newton": {}},
}


def test_the_scene_is_the_experiments(scene):
    assert len(scene) == len(scene.levels) == 2
    coarse, fine = scene.levels
    assert (coarse.vertex_count, fine.vertex_count) == (36, 121)
    assert coarse.rest.shape == (36, 3) and coarse.triangles.shape == (50, 3)
    assert fine.triangles.shape == (200, 3)
    assert numpy.all(coarse.edges[:, 0] < coarse.edges[:, 1])
    assert coarse.vertex_area.sum() == pytest.approx(1)
    assert scene[-1].level.index == 1
    with pytest.raises(IndexError):
        scene[2]
    assert scene[0].fixed.sum() == 2
    assert numpy.allclose(scene[0].masses, scene[0].material.area_density * coarse.vertex_area)
    for weights in (scene.prolongations[0], scene.midpoints[0], scene.linear[0]):
        assert scipy.sparse.issparse(weights) and weights.shape == (121, 36)
        assert numpy.allclose(weights.sum(axis=1), 1)
    assert numpy.allclose(scene.prolongations[0] @ coarse.rest, fine.rest)


@pytest.mark.parametrize("source", ["small", "contact"])
def test_derivatives(source, small):
    scene = drape.Experiment(small if source == "small" else CONTACT).scene()
    model, rng = scene[0], numpy.random.default_rng(1)
    x = scene.start(0) + 1e-4 * rng.standard_normal(scene.start(0).shape)
    if source == "contact":
        assert model.contacts(x)[0]["count"] > 0
    d, h = rng.standard_normal(x.shape), 1e-7
    slope = (model.energy(x + h * d) - model.energy(x - h * d)) / (2 * h)
    assert numpy.vdot(model.gradient(x), d) == pytest.approx(slope, rel=1e-4)
    change = (model.gradient(x + h * d) - model.gradient(x - h * d)).ravel() / (2 * h)
    hessian = model.hessian(x)
    assert isinstance(hessian, scipy.sparse.bsr_matrix) and hessian.has_sorted_indices
    assert numpy.linalg.norm(hessian @ d.ravel() - change) < 1e-4 * numpy.linalg.norm(change)
    assert abs(hessian - hessian.T).max() < 1e-12 * abs(hessian).max()
    projected = numpy.linalg.eigvalsh(model.hessian(x, "clamp").toarray())
    assert projected[0] > -1e-10 * projected[-1]
    assert sum(model.energy_parts(x).values()) == pytest.approx(model.energy(x), rel=1e-12)


def test_energies_of_one_type_keep_their_parts(small):
    small["energies"] += [{"type": "constant_load", "force_density": force} for force in ([0.1, 0, 0], [0, 0.3, 0])]
    experiment = drape.Experiment({**small, "metrics": ["energy"]})
    level = run(experiment)["pcs"].levels[-1]
    names = ["neo_hookean", "hinge", "gravity", "constant_load", "constant_load 2"]
    model = experiment.scene()[1]
    assert list(level.energy_parts) == list(model.energy_parts(level.x)) == names
    assert sum(level.energy_parts.values()) == pytest.approx(level.energy, rel=1e-12)
    measured = experiment.scene().metric("energy", 1, level.x)
    assert [measured[f"energy_parts.{name}"] for name in names] == list(level.energy_parts.values())


def test_contacts():
    scene = drape.Experiment(CONTACT).scene()
    x = scene.start(0)
    (contacts,) = scene[0].contacts(x)
    assert contacts["smallest_gap"] == pytest.approx(5e-4)
    assert contacts["gaps"].shape == contacts["vertices"].shape[:1] and len(contacts["gaps"]) > 0
    assert contacts["gaps"].min() == contacts["smallest_gap"]
    assert contacts["forces"][24, 2] > 0  # the centre of 7×7
    assert contacts["energy"] == scene[0].energy_parts(x)["contact"]
    assert scene[0].intersections(x) == []
    down = x - [0, 0, 0.01]
    fraction, by = scene[0].max_step(x, down)
    assert 0 < fraction < 0.06 and "ball" in by
    first, second, where = scene[0].intersections(down)[0]
    assert "ball" in first + second and len(where) == 3
    # States that contacts cannot search.
    model = scene[0]
    for wrong in (numpy.nan * x, numpy.where(x == x[0, 0], numpy.inf, x), 1e30 + x):
        for ask in (model.energy, model.gradient, model.hessian, model.energy_parts, model.force_residual,
                    model.contacts, model.intersections, lambda y: model.max_step(x, y)):
            with pytest.raises(ValueError, match="must be finite"):
                ask(wrong)


def test_metrics(scene, experiment):
    level = run(experiment)["pcs"].levels[0]
    assert scene.metric("stretch", 0, level.x)["largest_stretch"] == level.largest_stretch
    with pytest.raises(KeyError):
        scene.metric("nothing_such", 0, level.x)
    with pytest.raises(RuntimeError):
        scene.metric("distance", 0, level.x)  # of pairs


def test_previews_are_measured_by_their_methods_interpolation(small):
    small["refiner"] = "loop"  # which moves the surface
    small |= {"methods": {"pcs": {}, "by_refiner": {"type": "pcs", "interpolation": {"state": "refiner"}}}, "reference": {}}
    experiment = drape.Experiment(small)
    scene, result, distances = experiment.scene(), run(experiment, methods="all"), set()
    for method, weights in ("pcs", scene.linear), ("by_refiner", scene.prolongations):
        preview, end = (level.x for level in result[method].levels)
        prolonged = scene.prolong(method, 0, preview)
        assert abs(prolonged - weights[0] @ preview).max() < 1e-15
        measured = scene.metric("distance", 1, end, prolonged)["distance_rms"]
        pairs = result.consistency
        assert measured == pairs[pairs["method"] == method]["distance_rms"].iloc[0]
        distances.add(measured)
        assert (scene.prolong(method, 1, end) == end).all()
    assert len(distances) == 2
    with pytest.raises(ValueError, match="nothing_such"):
        scene.prolong("nothing_such", 0, scene.start(0))


def test_arrays_outlive_their_owners(experiment):
    scene = experiment.scene()
    arrays = scene.levels[1].rest, scene[1].masses, scene.start(1)
    copies, model, x = [numpy.array(a) for a in arrays], scene[0], numpy.array(scene.start(0))
    energy = model.energy(x)
    del scene
    gc.collect()
    assert all(numpy.array_equal(array, copy) for array, copy in zip(arrays, copies))
    assert model.energy(x) == energy


def test_what_would_change_nothing_is_refused(scene, experiment):
    for array in (scene[0].masses, scene[0].fixed, scene.start(0), scene.levels[0].rest, scene.prolongations[0].data,
                  scene.midpoints[0].indices, scene.linear[0].indptr):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0
    for owner, name in ((scene[0].material, "density"), (scene[0], "material"), (scene, "levels"), (experiment, "levels")):
        with pytest.raises(AttributeError):
            setattr(owner, name, 1)
    with pytest.raises(TypeError):
        scene.prolongations[0] = scene.linear[0]
    record = run(experiment)["pcs"]
    for owner in (record, record.levels[0]):
        with pytest.raises(AttributeError, match="status cannot be set"):
            owner.status = "converged"


def test_wrong_shapes_and_types(scene):
    model, x = scene[0], numpy.array(scene.start(0))
    for wrong in (x[:-1], x.T, x.ravel(), numpy.zeros((36, 4)), 7.0):
        with pytest.raises(ValueError, match="shape"):
            model.energy(wrong)
    for wrong in (x.astype(complex), x.astype(str), x.astype(object), None):
        with pytest.raises(TypeError, match="real numbers"):
            model.gradient(wrong)
    assert model.energy(x.tolist()) == model.energy(x)
    assert model.energy(numpy.asfortranarray(x)) == model.energy(x)
    assert model.energy(x.astype(numpy.float32)) == pytest.approx(model.energy(x), rel=1e-3)
    with pytest.raises(ValueError, match="projection must be"):
        model.hessian(x, "all")
    with pytest.raises(ValueError, match="blend"):
        model.hessian(x, "clamp", 2)


def test_a_material_has_its_stiffness_by_direction(small):
    material = drape.Experiment({**small, "material": {"fabric": "gray-interlock"}}).scene()[0].material
    assert (material.warp_bending, material.weft_bending, material.bias_bending) == (23.19e-6, 14.27e-6, 24.75e-6)
    assert (material.warp_stiffness, material.weft_stiffness, material.shear_stiffness) == (16.59, 34.48, 18.43)
    assert material.mean_bending_modulus * material.thickness**3 / 12 == pytest.approx((23.19e-6 * 14.27e-6) ** 0.5)
