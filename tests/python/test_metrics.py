"""What is refused of a metric in Python."""

import numpy
import pytest

import drape


@pytest.mark.parametrize("columns, message", [
    ({}, "Overhang.columns must be a dict with a drape.Column for every value that measure returns"),
    (["overhang"], r"Overhang.columns must be a dict .*, not \['overhang'\]"),
    ({"overhang": "m"}, "Overhang.columns: \"overhang\" must be a drape.Column, such as .*, not 'm'"),
    ({1: drape.Column()}, "Overhang.columns: a name must be a str, not 1"),
    ({"overhang": drape.Column(unit=1)}, r'Overhang.columns\["overhang"\].unit must be a str, not 1'),
    ({"overhang": drape.Column(label=1)}, r'Overhang.columns\["overhang"\].label must be a str or None, not 1'),
    ({"overhang": drape.Column(better="best")}, r'Overhang.columns\["overhang"\].better must be lower, higher or neither'),
    ({"status": drape.Column()}, 'the value "status" needs another name: results.json has a key "status" of its own'),
    ({"largest_stretch": drape.Column()}, 'the value "largest_stretch" is declared by metric stretch too'),
])
def test_a_metric_declares_its_columns(columns, message):
    with pytest.raises((TypeError, ValueError), match=message):
        drape.register("faulty", type("Overhang", (drape.Metric,), {"columns": columns}))
    assert "faulty" not in dict(drape.plugins("metric"))


@pytest.mark.parametrize("answer, error, message", [
    ({"overhng": 1.0}, ValueError, "Overhang.measure returned \"overhng\", which is not in Overhang.columns"),
    (1.5, TypeError, "Overhang.measure must return a dict from the names in Overhang.columns to numbers, not 1.5"),
    ({"overhang": "far"}, TypeError, "Overhang.measure must return a number for \"overhang\", not 'far'"),
    ({"overhang": numpy.ones(36)}, TypeError, r"a number for \"overhang\", not an array of the shape \(36,\)"),
    ({"overhang": numpy.complex128(1)}, TypeError, "a number for \"overhang\""),
])
def test_a_metric_returns_the_numbers_that_it_declares(small, answer, error, message):
    class Overhang(drape.Metric):
        parameters = {"faulty": False}  # experiments that name no metrics have this one too
        columns = {"overhang": drape.Column("m", "neither")}

        def measure(self, level, x, other):
            return answer if self.faulty else {"overhang": 1.0}

    drape.register("overhang", Overhang)
    with pytest.raises(error, match=message):
        drape.Experiment({**small, "metrics": [{"type": "overhang", "faulty": True}]}).run(progress=False)


def test_a_scope_is_one_that_exists():
    for scope, error in (("pairs", ValueError), (1, TypeError)):
        with pytest.raises(error, match="Overhang.scope must be"):
            drape.register("faulty", type("Overhang", (drape.Metric,), {"columns": {"a": drape.Column()}, "scope": scope}))
