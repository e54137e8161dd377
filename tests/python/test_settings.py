"""What Experiment.set refuses, and what it leaves to check."""

import pytest

import drape


@pytest.mark.parametrize("key, value", [
    ("material.thicknes", 1), ("material.thickness", -1), ("material.thickness", "thick"),
    ("material", {"thicknes": 1}), ("energies.0", "nothing_such"),
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


def test_a_text_that_a_config_cannot_hold_is_refused(experiment):
    with pytest.raises(ValueError, match="is no text that UTF-8 can hold"):
        experiment.set("name", "\ud800")


def test_what_a_schedule_sets_is_refused(small):
    keys = [{"parameter": "energies.gravity.acceleration", "times": [0, 1], "values": [[0, 0, -5], [0, 0, -9.81]]}]
    energies = ["neo_hookean", "hinge", {"type": "gravity", "acceleration": [0, 0, -9.81]}]
    scheduled = {**small, "energies": energies, "schedule": {"keys": keys}}
    for key, value in (("energies.gravity.acceleration", [0, 0, -1]), ("energies.2.acceleration", [0, 0, -1])):
        with pytest.raises(drape.ConfigError, match="a schedule sets it"):
            drape.Experiment(scheduled).set(key, value)
