"""Plugins in C++ that Python compiles and loads."""

import pytest

import drape
from conftest import run

SOURCE = """#include "core/numerics/formulas/energy_formula.h"
DRAPE_MEMBRANE(rubber_band, "Isotropic.") {
  return STIFFNESS * (g11 * g11 + g22 * g22 + 2 * g12 * g12);
}
"""


@pytest.fixture
def source(tmp_path, monkeypatch):
    """A function that writes the plugin's source with this stiffness and returns its path."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    def write(stiffness):
        (tmp_path / "rubber_band.cpp").write_text(SOURCE.replace("STIFFNESS", stiffness))
        return tmp_path / "rubber_band.cpp"

    return write


def test_a_source_is_compiled_and_loaded_and_the_same_file_may_change(small, source, tmp_path):
    small["energies"][0] = "rubber_band"
    with pytest.raises(drape.ConfigError, match="given by drape.load_plugin or found by DRAPE_PLUGIN_PATH"):
        drape.Experiment(small).check()
    drape.load_plugin(source("20"))
    assert ("rubber_band", "Isotropic.") in drape.plugins("energy")
    before = drape.Experiment(small)
    energies = [run(before)["pcs"].levels[-1].energy]
    drape.load_plugin(source("20"))  # again, as a notebook's cell does
    drape.load_plugin(source("200"))
    energies.append(run(before)["pcs"].levels[-1].energy)
    assert abs(energies[0] - energies[1]) > 1e-3 * abs(energies[1])
    # A sweep's processes know it too.
    swept = drape.sweep(small, out=tmp_path / "sweep", methods="pcs", progress=False)
    assert list(swept["status"]) == ["converged"]
    with pytest.raises(RuntimeError, match="rubber_band.cpp: does not compile; (.|\n)* says why(.|\n)*NOTHING_SUCH"):
        drape.load_plugin(source("NOTHING_SUCH"))
    assert run(before)["pcs"].levels[-1].energy == energies[1]  # of what was loaded before


TWO = """#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/hierarchy/midpoint.h"
struct Own : drape::Refiner {
  drape::ProlongationMatrix weights(const drape::Level& coarse) const override { return drape::midpoint_weights(coarse); }
};
DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, Own>("first_of_two", "Midpoints.");
  registry.add<drape::Refiner, Own>("midpoint", "A name that is taken.");
}
"""


def test_a_plugin_that_cannot_be_loaded_leaves_nothing(source, tmp_path):
    names = drape.plugins("refiner")
    file = source("20")
    file.write_text(TWO)
    for _ in range(2):
        with pytest.raises(RuntimeError, match="midpoint"):
            drape.load_plugin(file)
    assert drape.plugins("refiner") == names
    with pytest.raises(RuntimeError, match="No such file"):
        drape.load_plugin(tmp_path / "none.cpp")
