"""Experiments and their results: the same as the command's."""

import gc
import json
import locale
import os
import pathlib
import pickle
import re
import shutil
import subprocess
import sys

import numpy
import pytest

import drape
from conftest import PRELOADED, SOURCE
from drape import plots


def test_version(command):
    said = subprocess.run([command, "--version"], capture_output=True, text=True, check=True).stdout
    assert said == f"drape {drape.__version__} ({drape.__commit__})\n"


def test_a_run_has_the_bits_of_the_command(small_file, command, tmp_path):
    subprocess.run([command, "run", small_file, "--method", "all", "-o", tmp_path / "command", "--no-report",
                    "-q"], check=True)
    theirs = drape.read_run(tmp_path / "command")
    experiment, seen = drape.Experiment(small_file), []
    ours = experiment.run(methods=["all"], progress=False, on_iteration=lambda i: seen.append(i.force_residual))
    assert experiment.methods == ours.methods == theirs.methods == ["pcs", "cascadic", "newton"]
    for method in theirs.methods:
        assert ours[method].status == theirs[method].status
        assert len(ours[method].levels) == 2
        for own, other in zip(ours[method].levels, theirs[method].levels):
            assert own.x.tobytes() == other.x.tobytes()
            assert own.largest_stretch == other.largest_stretch
    assert numpy.array_equal(ours.iterations["energy"], theirs.iterations["energy"])
    assert len(seen) == len(ours.iterations) > 10
    assert list(ours.iterations["step"][:3]) == [0, 1, 2]
    assert list(ours.iterations["iteration"][:3]) == [0, 0, 0]


def test_a_dict_is_the_same_experiment_as_its_file(small, small_file):
    of_dict = drape.Experiment(small).run(progress=False)
    of_file = drape.Experiment(str(small_file)).run(progress=False)
    assert of_dict.methods == of_file.methods == ["pcs"]  # the command's default
    assert of_dict["pcs"].levels[-1].x.tobytes() == of_file["pcs"].levels[-1].x.tobytes()


def test_set_is_the_commands(small_file, command, tmp_path):
    subprocess.run([command, "run", small_file, "-o", tmp_path / "r", "--no-report", "-q", "--set",
                    "energies.gravity.acceleration=[0, 0, -4]", "--set", "levels=1"], check=True)
    experiment = drape.Experiment(small_file)
    experiment.set("energies.gravity.acceleration", [0, 0, -4])
    experiment.set("levels", "1")
    assert experiment.resolved["levels"] == 1
    ours, theirs = experiment.run(progress=False)["pcs"], drape.read_run(tmp_path / "r")["pcs"]
    assert len(ours.levels) == 1
    assert ours.levels[0].x.tobytes() == theirs.levels[0].x.tobytes()


def test_a_kind_and_a_number_of_threads_are_checked():
    assert [name for name, _ in drape.plugins("refiner")] == ["loop", "midpoint"]
    with pytest.raises(ValueError, match="no kind \"enrgy\""):
        drape.plugins("enrgy")
    with pytest.raises(ValueError, match="at least 0"):
        drape.set_threads(-3)
    for count in (2, 0):
        drape.set_threads(count)


def test_every_fault_is_listed_with_its_place(tmp_path):
    file = tmp_path / "faulty.yaml"
    file.write_text("name: faulty\nlevls: 2\nmaterial: {density: -1}\nenergies: [gravity]\nmethods: {pcs: {}}\n")
    experiment = drape.Experiment(file)
    with pytest.raises(drape.ConfigError) as raised:
        experiment.check()
    faults = raised.value.faults
    assert [(f.file, f.line, f.key) for f in faults] == [(str(file), 2, "levls"), (str(file), 3, "material.density")]
    assert faults[0].column == 1 and "levels" in faults[0].message and "density" in faults[1].message
    assert str(raised.value).count("\n") == 1
    with pytest.raises(drape.ConfigError):
        experiment.run(progress=False)


def test_check_finds_an_energy_that_is_not_finite(small):
    small["start"] = {"scale": [0, 0, 1], "perturbation": 1e-3}
    with pytest.warns(UserWarning), pytest.raises(drape.ConfigError, match="energy neo_hookean is not"):
        drape.Experiment(small).check()


def test_a_fault_of_a_dict_names_its_key(small):
    small.update(contact="shapes", obstacles=[{"shape": "sphere", "radius": -1}], levls=2)
    with pytest.raises(drape.ConfigError) as raised:
        drape.Experiment(small).check()
    faults = raised.value.faults
    assert {fault.key for fault in faults} == {"levls", "obstacles.0.radius"}
    assert all(fault.file == "" and fault.line == 0 for fault in faults)
    assert "obstacles.0.radius: " in str(raised.value)


def test_what_is_no_experiment_is_refused(small, tmp_path):
    with pytest.raises(drape.ConfigError):
        drape.Experiment(tmp_path / "none.yaml")
    with pytest.raises(TypeError, match="a YAML file or a dict"):
        drape.Experiment(7)
    with pytest.raises(TypeError, match="cannot hold"):
        drape.Experiment({"name": object()})
    endless = {"name": "a"}
    endless["material"] = endless
    with pytest.raises(ValueError, match="too deeply"):
        drape.Experiment(endless)
    experiment = drape.Experiment(small)
    with pytest.raises(drape.ConfigError, match="--set pins.9"):
        experiment.set("pins.9.point", [0, 0, 0])
    experiment.check()  # nothing has changed
    with pytest.raises(RuntimeError, match="nothing_such"):
        experiment.run(methods=["nothing_such"], progress=False)


def test_results_in_a_folder_are_kept_and_not_overwritten(experiment, tmp_path):
    folder = tmp_path / "r"
    result = experiment.run(out=folder, report=False, progress=False)
    assert result.folder == str(folder) and result.complete
    with pytest.raises(RuntimeError, match="name another folder with out, or replace them with overwrite=True$"):
        experiment.run(out=folder, report=False, progress=False)
    experiment.run(out=folder, report=False, progress=False, overwrite=True)
    del result
    gc.collect()
    assert (folder / "results.json").exists()
    with pytest.raises(RuntimeError):
        drape.read_run(tmp_path / "none")


def test_a_temporary_folder_goes_away_and_its_arrays_stay(experiment):
    result = experiment.run(progress=False)
    folder, x = pathlib.Path(result.folder), result["pcs"].levels[-1].x
    level = result["pcs"].levels[0]
    copy = numpy.array(x)
    assert folder.exists() and not x.flags.writeable
    del result
    gc.collect()
    assert folder.exists()  # a level may be asked for its state yet
    assert level.x.shape == (36, 3)
    del level
    gc.collect()
    assert not folder.exists()
    assert numpy.array_equal(x, copy)


def test_a_result_is_pickled_if_its_folder_stays(experiment, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kept, temporary = experiment.run(out="r", report=False, progress=False), experiment.run(progress=False)
    text = pickle.dumps((kept, kept["pcs"].levels[-1]))
    monkeypatch.chdir("/")
    result, level = pickle.loads(text)
    x = drape.read_run(tmp_path / "r")["pcs"].levels[-1].x
    assert numpy.array_equal(result["pcs"].levels[-1].x, x) and numpy.array_equal(level.x, x)
    assert result.levels.equals(kept.levels)
    for part in (temporary, temporary["pcs"].levels[0]):
        with pytest.raises(TypeError, match="its folder is temporary; give run a folder, as in out="):
            pickle.dumps(part)


def test_tables(experiment):
    result = experiment.run(methods=["all"], progress=False)
    assert list(result.levels["method"]) == [m for m in ("pcs", "cascadic", "newton") for _ in range(2)]
    assert list(result.levels["level"]) == [0, 1] * 3
    assert numpy.all(numpy.isfinite(result.levels["energy"]))
    parts = sum(result.levels[c] for c in result.levels if c.startswith("energy_parts."))
    assert numpy.allclose(parts, result.levels["energy"], rtol=1e-12)
    assert len(result.iterations) == sum(result.levels["iterations"])
    assert list(drape.read_sweep(result.folder)["method"]) == result.methods
    assert len(result.consistency) == 3 and "d_H_fit" in result.consistency
    assert result.levels["level"].dtype == result.iterations["level"].dtype == int
    assert result.levels["smallest_gap"].dtype == float  # of a run without contact


def test_names_are_those_of_the_files(experiment):
    result = experiment.run(methods=["all"], progress=False)
    folder = pathlib.Path(result.folder)
    for table, name in ((result.iterations, "iterations.csv"), (result.errors, "errors.csv")):
        assert list(table) == (folder / name).read_text().splitlines()[0].split(",")
    recorded = json.loads((folder / "results.json").read_text())["methods"]["pcs"]["levels"][0]
    assert {"iterations", "energy_released", "energy_parts.hinge", "seconds_by_phase.factorise"} <= set(result.levels)
    level = result["pcs"].levels[0]
    for name, value in recorded.items():
        if isinstance(value, (int, float)):
            assert result.levels[name][0] == value
        assert name == "triangles" or getattr(level, name) == value
    iteration = set(dir(drape.Iteration))
    assert {name for name in result.iterations if name not in ("method", "intersections")} <= iteration


def test_a_sweep_is_one_table(command, tmp_path):
    subprocess.run([command, "sweep", SOURCE / "tests/sweep/small_sweep.yaml", "--out", tmp_path / "out", "-q"], check=True,
                   stdout=subprocess.DEVNULL)
    frame = drape.read_sweep(tmp_path / "out")
    assert len(frame) == 48
    assert frame["levels"].dtype == frame["seed"].dtype == int
    of = frame[(frame["refiner"] == "loop") & (frame["levels"] == 2) & (frame["method"] == "pcs")]
    assert len(of) == 6 and set(of["newton.step_growth"]) == {1.5, 3} and set(of["seed"]) == {1, 2, 3}
    assert numpy.all(of["energy_released"] > 0)
    with pytest.raises(RuntimeError, match="neither results.json nor sweep.json"):
        drape.read_sweep(tmp_path / "out/runs")


@pytest.fixture
def set_decimal_comma(tmp_path, monkeypatch):
    """Gives the process a locale whose numbers have a decimal comma, made by the localedef of libc-bin."""
    source, charmap, made = tmp_path / "source", tmp_path / "charmap", tmp_path / "decimal_comma"
    source.write_text('LC_NUMERIC\ndecimal_point ","\nthousands_sep ""\ngrouping -1\nEND LC_NUMERIC\n')
    charmap.write_text("CHARMAP\nEND CHARMAP\n")
    if shutil.which("localedef") is None:
        pytest.skip("needs localedef")
    # It misses the other categories, says so by its exit code, and writes the locale.
    subprocess.run(["localedef", "-c", "-i", source, "-f", charmap, made], capture_output=True)
    monkeypatch.setenv("LOCPATH", str(tmp_path))
    before = locale.setlocale(locale.LC_NUMERIC)
    yield lambda: locale.setlocale(locale.LC_NUMERIC, made.name)
    locale.setlocale(locale.LC_NUMERIC, before)


def test_files_are_the_same_in_every_locale(experiment, tmp_path, set_decimal_comma):
    experiment.run(out=tmp_path / "point", report=False, progress=False)
    expected = drape.read_run(tmp_path / "point")
    set_decimal_comma()
    assert locale.format_string("%.1f", 0.5) == "0,5"
    again = drape.read_run(tmp_path / "point")
    experiment.run(out=tmp_path / "comma", progress=False)
    ours = drape.read_run(tmp_path / "comma")
    for table in (again.iterations, ours.iterations):
        assert numpy.array_equal(table["force_residual"], expected.iterations["force_residual"])
    assert numpy.array_equal(again.errors["seconds"], expected.errors["seconds"])
    for name in ("iterations.csv", "errors.csv"):
        lines = (tmp_path / "comma" / name).read_text().splitlines()
        assert {line.count(",") for line in lines} == {lines[0].count(",")}
    page = (tmp_path / "comma/report.html").read_text()
    json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])


def test_a_result_shows_itself(experiment, monkeypatch, tmp_path):
    result = experiment.run(progress=False)
    shown = result._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "viewer-l0" in shown
    assert 'sandbox="allow-scripts allow-downloads"' in shown  # its buttons save files
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    result.show()
    assert len(opened) == 1 and opened[0].startswith("file://")
    page = drape.show(experiment.scene(), result["pcs"].levels[-1].x)
    assert "viewer-canvas" in page.text


def test_plots_have_the_reports_colours():
    style = (SOURCE / "viewer/page.css").read_text()
    light = {n: colour for n, colour in reversed(re.findall(r"--solver-(\d): (#[0-9a-f]{6})", style))}
    assert list(plots.COLOURS) == [light[str(n)] for n in range(len(light))]


def test_plots(experiment):
    pytest.importorskip("matplotlib").use("Agg")
    result = experiment.run(methods=["all"], progress=False)
    axes = result.plot_errors()
    assert axes.get_ylabel() == "reference_rms"
    looks = {line.get_label(): (line.get_color(), line.get_marker()) for line in axes.lines}
    assert looks == {"pcs": ("#0072b2", "o"), "cascadic": ("#d55e00", "s"), "newton": ("#009e73", "^")}
    newton = result.errors[(result.errors["method"] == "newton") & (result.errors["level"] == 1)]
    assert set(axes.lines[2].get_xdata()) == set(newton["seconds"])
    own = experiment.run(methods=["cascadic", "newton"], progress=False).plot_errors(target="own")
    assert {line.get_label(): line.get_color() for line in own.lines} == {"cascadic": "#d55e00", "newton": "#009e73"}
    assert len(result.plot_convergence().lines) == 6
    with pytest.raises(ValueError, match="choose a measure"):
        result.plot_errors(measure="nothing_such")


@pytest.mark.skipif("DRAPE_TEST_PLUGINS" not in os.environ, reason="the tests' plugins are not built")
def test_a_plugin_of_another_abi_is_refused():
    path = pathlib.Path(os.environ["DRAPE_TEST_PLUGINS"]) / "wrong_abi"
    ended = subprocess.run([sys.executable, "-c", "import drape; drape.plugins('energy')"], capture_output=True,
                           text=True, env={**os.environ, **PRELOADED, "DRAPE_PLUGIN_PATH": str(path)})
    assert ended.returncode == 1
    assert "RuntimeError" in ended.stderr and "does not fit this drape" in ended.stderr
