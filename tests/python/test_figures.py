"""`drape figures`: what it writes of a run and of a sweep."""

import csv
import subprocess

import pandas
import pytest

pytest.importorskip("matplotlib")
from drape.figures import latex_table  # noqa: E402

SWEEP = """name: two
base: {base}
seeds: [1, 2]
methods: [pcs, newton]
"""
GRID = "ablation: {grid: {newton.step_growth: [1.5, 3]}}\n"
NOTHING_PINNED = "set: {pins: [{region: ball, point: [9, 9, 9], radius: 0.1}]}"


@pytest.fixture
def swept(tmp_path, command, small_file):
    """The folder of a sweep of the small experiment, whose file ends with this text."""

    def sweep(text, succeeds=True):
        (tmp_path / "two.yaml").write_text(SWEEP.format(base=small_file) + text)
        subprocess.run([command, "sweep", tmp_path / "two.yaml", "-o", tmp_path / "sweep"], check=succeeds, stdout=subprocess.DEVNULL)
        return tmp_path / "sweep"

    return sweep


@pytest.fixture
def written(tmp_path, command):
    """What the command writes of a folder of results, by name."""

    def write(results) -> dict:
        out = tmp_path / "figures"
        ended = subprocess.run([command, "figures", results, "-o", out], check=True, capture_output=True, text=True)
        assert "Warning" not in ended.stderr
        return {file.name: file for file in out.iterdir()}

    return write


def test_figures_of_a_run(written, command, small_file, tmp_path):
    subprocess.run([command, "run", small_file, "--method", "all", "-o", tmp_path / "run", "--no-report", "-q"], check=True)
    files = written(tmp_path / "run")
    for method in ("pcs", "cascadic", "newton"):
        for picture in ("preview", "end", "outline"):
            assert files[f"{method}_{picture}.png"].read_bytes()[1:4] == b"PNG"
    for plot in ("convergence", "distance_own", "distance_reference"):
        assert {plot + ".svg", plot + ".png"} <= set(files)
    assert "<text" in files["distance_own.svg"].read_text()
    assert (tmp_path / "run/errors.csv").read_bytes() == files["errors.csv"].read_bytes()
    table = files["table.tex"].read_text()
    assert table.startswith(r"\begin{tabular}{l") and r"\toprule" in table
    assert "pcs & 1 of 1 & " in table


def test_figures_of_a_sweep(written, swept):
    files = written(swept(GRID))
    assert {"seconds_by_step_growth.svg", "preview_rms_by_step_growth.png"} <= set(files)
    with files["table.csv"].open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 8 and {float(row["newton.step_growth"]) for row in rows} == {1.5, 3}
    assert r"step\_growth & method & converged" in files["table.tex"].read_text()
    assert r"1.5 & pcs & 2 of 2 & " in files["table.tex"].read_text()


def test_plots_of_keys_with_one_last_part_are_apart(written, swept):
    files = written(swept("ablation: {grid: {newton.step_size: [0.1, 0.2], methods.newton.newton.step_size: [0.1, 0.2]}}\n"))
    assert {"seconds_by_newton_step_size.svg", "seconds_by_methods_newton_newton_step_size.svg"} <= set(files)


def test_a_sweep_without_results_has_no_figures(swept, command, tmp_path):
    sweep = swept(GRID + NOTHING_PINNED, succeeds=False)
    ended = subprocess.run([command, "figures", sweep, "-o", tmp_path / "out"], capture_output=True, text=True)
    assert ended.returncode == 2 and "no run has written results yet" in ended.stderr


def test_a_folder_without_results_has_no_figures(command, tmp_path):
    ended = subprocess.run([command, "figures", tmp_path, "-o", tmp_path / "figures"], capture_output=True, text=True)
    assert ended.returncode == 2 and "neither results.json nor sweep.json here" in ended.stderr


def test_a_method_has_converged_if_all_its_levels_have():
    status = ["converged", "converged, max_steps_reached", "converged_to_rounding, converged", "converged, failed"]
    rows = pandas.DataFrame({"run": "a", "seed": [1, 2, 3, 4], "method": "pcs", "status": status, "seconds": [1.0, 50.0, 1.0, 70.0]})
    assert r"pcs & 2 of 4 & 1 \\" in latex_table(rows)


def test_runs_without_results_are_in_the_tables(written, swept):
    files = written(swept(f"ablation: [{{name: whole}}, {{name: far, {NOTHING_PINNED}}}]", succeeds=False))
    with files["table.csv"].open(newline="") as lines:
        assert len(list(csv.DictReader(lines))) == 6
    assert " & -- & 0 of 2 & " in files["table.tex"].read_text()


def test_a_key_that_is_null_in_some_runs_keeps_them_in_its_plots(written, swept):
    files = written(swept("ablation: {grid: {material.warp_bending: [null, 1e-6]}}"))
    assert ">--<" in files["seconds_by_warp_bending.svg"].read_text()
