"""Experiments and their results: the same as the command's."""

import gc
import json
import locale
import pathlib
import pickle
import re
import shutil
import subprocess

import numpy
import pytest

import drape
from conftest import SMALL_FILE, SOURCE, bits_of, command, run
from drape import plots

ALL = ["pcs", "cascadic", "newton"]


def test_a_run_has_the_bits_of_the_command(tmp_path):
    assert command("--version").stdout == f"drape {drape.__version__} ({drape.__commit__})\n"
    assert [name for name, _ in drape.plugins("refiner")] == ["coarsen", "loop", "midpoint"]
    command("run", SMALL_FILE, "--method", "all", "-o", tmp_path / "r", "--no-report", "-q", "--set",
            "energies.gravity.acceleration=[0, 0, -4]", "--set", "cloth.columns=7")
    experiment, theirs, seen = drape.Experiment(SMALL_FILE), drape.read_run(tmp_path / "r"), []
    experiment.set("energies.gravity.acceleration", [0, 0, -4])
    experiment.set("cloth.columns", "7")  # a text is read as the command reads it
    assert experiment.resolved["cloth"]["columns"] == 7
    ours = run(experiment, methods=["all"], on_iteration=lambda i: seen.append(i.force_residual))
    assert experiment.methods == ours.methods == theirs.methods == ALL
    for method in theirs.methods:
        assert ours[method].status == theirs[method].status
        assert len(ours[method].levels) == 2
        for level, other in zip(ours[method].levels, theirs[method].levels):
            assert level.x.tobytes() == other.x.tobytes()
            assert level.largest_stretch == other.largest_stretch
    assert numpy.array_equal(ours.iterations["energy"], theirs.iterations["energy"])
    assert len(seen) == len(ours.iterations) > 10
    assert list(ours.iterations["step"][:3]) == [0, 1, 2]
    assert list(ours.iterations["iteration"][:3]) == [0, 0, 0]


def test_a_dict_is_the_same_experiment_as_its_file(small):
    of_dict, of_file = run(small), run(drape.Experiment(str(SMALL_FILE)))
    assert of_dict.methods == of_file.methods == ["pcs"]  # the command's default
    assert bits_of(of_dict) == bits_of(of_file)


def test_results_in_a_folder_are_kept_and_not_overwritten(experiment, tmp_path):
    folder = tmp_path / "r"
    result = run(experiment, out=folder, report=False)
    assert result.folder == str(folder) and result.complete
    with pytest.raises(RuntimeError, match="name another folder with out, or replace them with overwrite=True$"):
        run(experiment, out=folder, report=False)
    run(experiment, out=folder, report=False, overwrite=True)
    del result
    gc.collect()
    assert (folder / "results.json").exists()
    with pytest.raises(RuntimeError):
        drape.read_run(tmp_path / "none")


def test_a_temporary_folder_goes_away_and_its_arrays_stay(experiment):
    result = run(experiment)
    folder, x, level = pathlib.Path(result.folder), result["pcs"].levels[-1].x, result["pcs"].levels[0]
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
    kept, temporary = run(experiment, out="r", report=False), run(experiment)
    text = pickle.dumps((kept, kept["pcs"].levels[-1]))
    monkeypatch.chdir("/")
    result, level = pickle.loads(text)
    assert bits_of(result) == level.x.tobytes() == bits_of(drape.read_run(tmp_path / "r"))
    assert result.levels.equals(kept.levels)
    for part in (temporary, temporary["pcs"].levels[0]):
        with pytest.raises(TypeError, match="its folder is temporary; give run a folder, as in out="):
            pickle.dumps(part)


def test_tables_have_the_names_and_numbers_of_the_files(experiment):
    result = run(experiment, methods=["all"])
    folder, levels = pathlib.Path(result.folder), result.levels
    assert list(levels["method"]) == [m for m in ALL for _ in range(2)] and list(levels["level"]) == [0, 1] * 3
    parts = sum(levels[name] for name in levels if name.startswith("energy_parts."))
    assert numpy.allclose(parts, levels["energy"], rtol=1e-12)
    assert len(result.iterations) == sum(levels["iterations"])
    assert list(drape.read_sweep(folder)["method"]) == result.methods
    assert len(result.consistency) == 3 and "d_H_fit" in result.consistency
    assert levels["level"].dtype == result.iterations["level"].dtype == int
    assert levels["smallest_gap"].dtype == float  # of a run without contact
    for table, name in ((result.iterations, "iterations.csv"), (result.errors, "errors.csv")):
        assert list(table) == (folder / name).read_text().splitlines()[0].split(",")
    recorded = json.loads((folder / "results.json").read_text())["methods"]["pcs"]["levels"][0]
    assert {"iterations", "energy_released", "energy_parts.hinge", "seconds_by_phase.factorise"} <= set(levels)
    for name, value in recorded.items():
        if isinstance(value, (int, float)):
            assert levels[name][0] == value
        assert name == "triangles" or getattr(result["pcs"].levels[0], name) == value
    assert {name for name in result.iterations if name not in ("method", "intersections")} <= set(dir(drape.Iteration))


def test_names_of_methods_are_texts_in_tables(small):
    del small["reference"]
    small["methods"] = {name: {"type": "newton"} for name in ("nan", "inf")}
    result = run(small, methods=["all"])
    for table in (result.levels, result.iterations, result.errors):
        assert set(table["method"]) == {"nan", "inf"}


def test_files_are_the_same_in_every_locale(experiment, tmp_path, monkeypatch):
    """In a locale whose numbers have a decimal comma, made by the localedef of libc-bin."""
    if shutil.which("localedef") is None:
        pytest.skip("needs localedef")
    source, charmap, made = tmp_path / "source", tmp_path / "charmap", tmp_path / "decimal_comma"
    source.write_text('LC_NUMERIC\ndecimal_point ","\nthousands_sep ""\ngrouping -1\nEND LC_NUMERIC\n')
    charmap.write_text("CHARMAP\nEND CHARMAP\n")
    # It misses the other categories, says so by its exit code, and writes the locale.
    subprocess.run(["localedef", "-c", "-i", source, "-f", charmap, made], capture_output=True)
    monkeypatch.setenv("LOCPATH", str(tmp_path))
    run(experiment, out=tmp_path / "point", report=False)
    expected, before = drape.read_run(tmp_path / "point"), locale.setlocale(locale.LC_NUMERIC)
    locale.setlocale(locale.LC_NUMERIC, made.name)
    try:
        assert locale.format_string("%.1f", 0.5) == "0,5"
        again = drape.read_run(tmp_path / "point")
        run(experiment, out=tmp_path / "comma")
        ours = drape.read_run(tmp_path / "comma")
    finally:
        locale.setlocale(locale.LC_NUMERIC, before)
    for table in (again.iterations, ours.iterations):
        assert numpy.array_equal(table["force_residual"], expected.iterations["force_residual"])
    assert numpy.array_equal(again.errors["seconds"], expected.errors["seconds"])
    for name in ("iterations.csv", "errors.csv"):
        lines = (tmp_path / "comma" / name).read_text().splitlines()
        assert {line.count(",") for line in lines} == {lines[0].count(",")}
    page = (tmp_path / "comma/report.html").read_text()
    json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])


def test_a_result_shows_itself(experiment, monkeypatch, tmp_path):
    result, opened = run(experiment), []
    shown = result._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "viewer-l0" in shown
    assert 'sandbox="allow-scripts allow-downloads"' in shown  # its buttons save files
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    result.show()
    assert len(opened) == 1 and opened[0].startswith("file://")
    assert "viewer-canvas" in drape.show(experiment.scene(), result["pcs"].levels[-1].x).text


def test_plots_have_the_reports_colours(experiment):
    style = (SOURCE / "viewer/page.css").read_text()
    light = {n: colour for n, colour in reversed(re.findall(r"--solver-(\d): (#[0-9a-f]{6})", style))}
    assert list(plots.COLOURS) == [light[str(n)] for n in range(len(light))]

    pytest.importorskip("matplotlib").use("Agg")
    result = run(experiment, methods=["all"])
    axes = result.plot_errors()
    assert axes.get_ylabel() == "RMS distance from the reference [diagonal]"
    looks = {line.get_label(): (line.get_color(), line.get_marker()) for line in axes.lines}
    assert looks == {"pcs": ("#0072b2", "o"), "cascadic": ("#d55e00", "s"), "newton": ("#009e73", "^")}
    newton = result.errors[(result.errors["method"] == "newton") & (result.errors["level"] == 1)]
    assert set(axes.lines[2].get_xdata()) == set(newton["seconds"])
    fewer = run(experiment, methods=["cascadic", "newton"]).plot_errors(target="own")
    assert {line.get_label(): line.get_color() for line in fewer.lines} == {"cascadic": "#d55e00", "newton": "#009e73"}
    assert len(result.plot_convergence().lines) == 6
    with pytest.raises(ValueError, match="choose a measure"):
        result.plot_errors(measure="nothing_such")


def test_a_mesh_of_arrays_rests_in_space_or_as_flat_pieces():
    x = numpy.array([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0.0]])
    triangles = numpy.array([[0, 1, 2], [0, 2, 3]])
    corners = x[triangles][:, :, :2].copy()
    corners[1] += [1, 0.3]  # a piece of its own
    in_space = drape.Experiment(mesh=(x, triangles))
    sewn = drape.Experiment(mesh=(x, triangles), rest=corners)
    for experiment in (in_space, sewn):
        experiment.set("levels", 2)
        experiment.set("refiner", "midpoint")
    assert sewn.resolved["cloth"]["rest"] == "uv"
    levels, flat = in_space.scene().levels, sewn.scene().levels
    for level, other in zip(levels, flat):
        assert numpy.allclose(level.vertex_area, other.vertex_area, rtol=1e-12)
    assert numpy.array_equal(flat[0].rest_corners.reshape(-1, 3, 3)[:, :, :2], corners)
    assert not flat[1].rest_corners.reshape(-1, 3)[:, 2].any()
    with pytest.raises(ValueError, match="corners of 1 triangles"):
        drape.Experiment(mesh=(x, triangles), rest=corners[:1])
    with pytest.raises(TypeError, match="give mesh"):
        drape.Experiment("e.yaml", rest=corners)
