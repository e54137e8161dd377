"""`drape figures`: what it writes of a run and of a sweep."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
import pandas
import pytest

import drape
from conftest import SMALL_FILE, command

pytest.importorskip("matplotlib")
from drape import paper_sweep, plots  # noqa: E402
from drape.paper import _cell  # noqa: E402

SWEEP = f"name: two\nbase: {SMALL_FILE}\nseeds: [1, 2]\nmethods: [pcs, newton]\n"
GRID = "ablation: {grid: {newton.step_growth: [1.5, 3]}}\n"
NOTHING_PINNED = "set: {pins: [{region: ball, point: [9, 9, 9], radius: 0.1}]}"


@pytest.fixture
def swept(tmp_path):
    """The folder of a sweep of the small experiment, whose file ends with this text."""

    def sweep(text, code=0):
        (tmp_path / "two.yaml").write_text(SWEEP + text)
        command("sweep", tmp_path / "two.yaml", "-o", tmp_path / "sweep", code=code)
        return tmp_path / "sweep"

    return sweep


@pytest.fixture
def written(tmp_path):
    """What the command writes of a folder of results, by name."""

    def write(results) -> dict:
        assert "Warning" not in command("figures", results, "-o", tmp_path / "figures").stderr
        return {file.name: file for file in (tmp_path / "figures").iterdir()}

    return write


def check_latex(text):
    """The subset of LaTeX with booktabs that a table may be made of: what is checked here compiles."""
    assert set(re.findall(r"\\[a-zA-Z]+", text)) <= {r"\begin", r"\end", r"\begingroup", r"\endgroup", r"\small", r"\setlength", r"\tabcolsep",
                                                   r"\resizebox", r"\ifdim", r"\else", r"\fi", r"\width", r"\linewidth", r"\toprule", r"\midrule", r"\bottomrule", r"\textbf", r"\par", r"\smallskip", r"\footnotesize",
                                                   r"\scriptsize", r"\shortstack", r"\addlinespace", r"\cdot"}
    # No wider than the text.
    assert text.startswith("\\begingroup\n\\small\\setlength{\\tabcolsep}{4pt}\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{\n")
    columns, body = re.search(r"\\begin{tabular}{([lr]+)}\n(.*)\n\\end{tabular}\n}\\endgroup\n\\par", text, re.DOTALL).groups()
    rows = [line for line in body.split("\n") if not line.startswith("\\") or line.startswith(r"\shortstack")]
    assert len(rows) > 1 and all(line.endswith(r" \\") and len(re.findall(r"(?<!\\)&", line)) == len(columns) - 1 for line in rows)
    plain = re.sub(r"\\[\\&%$#_{}]", "", text)
    assert plain.count("{") == plain.count("}") and plain.count("$") % 2 == 0
    assert not re.search(r"[%#_^]", re.sub(r"\$[^$]*\$", "", plain))
    if shutil.which("kpsewhich") and not subprocess.run(["kpsewhich", "booktabs.sty"], stdout=subprocess.DEVNULL).returncode:
        page = "\n".join([r"\documentclass[landscape]{article}", r"\usepackage{booktabs,graphicx}", r"\begin{document}", text, r"\end{document}", ""])
        with tempfile.TemporaryDirectory() as folder:
            made = subprocess.run(["pdflatex", "-halt-on-error", "-output-directory", folder], input=page, capture_output=True, text=True)
        assert made.returncode == 0, made.stdout


def rows_of(file):
    with file.open(newline="") as lines:
        return list(csv.DictReader(lines))


def test_cells_are_those_of_drape_table():
    assert [_cell(value) for value in ("=1+1", "-1", "-a", "", 2.5)] == ["'=1+1", "-1", "'-a", "", 2.5]


def test_figures_of_a_run(written, tmp_path):
    command("run", SMALL_FILE, "--method", "all", "-o", tmp_path / "run", "--no-report", "-q")
    files = written(tmp_path / "run")
    for method in ("pcs", "cascadic", "newton"):
        for picture in ("preview", "end", "outline"):
            assert files[f"{method}_{picture}.png"].read_bytes()[1:4] == b"PNG"
    for plot in ("convergence", "distance_own", "distance_reference"):
        assert {plot + ".svg", plot + ".png"} <= set(files)
    assert "<text" in files["distance_own.svg"].read_text()
    assert (tmp_path / "run/errors.csv").read_bytes() == files["errors.csv"].read_bytes()
    table = files["table.tex"].read_text()
    check_latex(table)
    assert "pcs & 1 of 1 & " in table


@pytest.fixture
def small_run(tmp_path):
    command("run", SMALL_FILE, "--method", "newton", "--levels", "1", "-o", tmp_path / "run", "--no-report", "-q")
    return tmp_path / "run"


@pytest.mark.parametrize("environment", [{}, {"PYTHONPATH": ""}, {"PYTHONPATH": os.pathsep}, {"DRAPE_PYTHON": "python3"}])
def test_nothing_of_the_current_folder_is_run(small_run, tmp_path, environment):
    here = tmp_path / "here"
    here.mkdir()
    for name in ("sitecustomize", "usercustomize", "numpy", "json", "argparse", "pandas", "matplotlib", "pathlib", "drape", "os"):
        (here / f"{name}.py").write_text("open('run', 'a').write(__name__)\n")
    (here / "python3").write_text("#!/bin/sh\necho python3 > run\n")
    (here / "python3").chmod(0o755)
    path = f"{os.path.dirname(sys.executable)}:{os.environ['PATH']}"
    command("figures", small_run, "-o", "figures", cwd=here, env={**os.environ, "PATH": path, **environment})
    assert not (here / "run").exists() and (here / "figures/table.tex").exists()


@pytest.mark.parametrize("name", ["table.tex", "convergence.svg", "newton_end.png", "errors.csv"])
def test_files_that_are_there_stay_unless_they_are_to_be_replaced(small_run, tmp_path, name):
    out, victim = tmp_path / "out", tmp_path / "victim"
    out.mkdir()
    victim.write_text("mine")
    (out / name).write_text("mine")
    assert f"{name}: exists already; name another file, or replace it with --overwrite" in command("figures", small_run, "-o", out, code=2).stderr
    assert [file.name for file in out.iterdir()] == [name] and (out / name).read_text() == "mine"
    (out / name).unlink()
    (out / name).symlink_to(victim)
    (out / f"{name}.part").symlink_to(victim)
    assert f"{name}: exists already; name another file, or replace it with --overwrite" in command("figures", small_run, "-o", out, code=2).stderr
    command("figures", small_run, "-o", out, "--overwrite")
    assert victim.read_text() == "mine" and not (out / name).is_symlink()


@pytest.mark.parametrize("text", ["method,level", "\udcff", "method,seconds,own_rms\nnewton,1,2\n",
                                  "method,level,seconds,iterations,own_rms\nnewton,\x1b[1m,1,1,2\nnewton,0,1,1,2\n"])
def test_errors_of_another_form_are_refused_in_a_line(small_run, tmp_path, text):
    command("table", small_run)  # measures it
    (small_run / "errors.csv").write_bytes(text.encode(errors="surrogateescape"))
    said = command("figures", small_run, "-o", tmp_path / "out", code=2).stderr
    assert said.startswith("error: the results are not as drape writes them (") and said.count("\n") == 1 and said[:-1].isprintable()


def test_a_sweep_is_one_table_and_has_figures(written, swept):
    sweep = swept(GRID)
    frame, files = drape.read_sweep(sweep), written(sweep)
    assert len(frame) == 8 and frame["seed"].dtype == int
    assert set(frame["newton.step_growth"]) == {1.5, 3} and set(frame["seed"]) == {1, 2}
    assert set(frame["method"]) == {"pcs", "newton"} and numpy.all(frame["energy_released"] > 0)
    with pytest.raises(RuntimeError, match="neither results.json nor sweep.json"):
        drape.read_sweep(sweep / "runs")
    assert {"seconds_by_step_growth.svg", "preview_rms_by_step_growth.png", "iterations_by_step_growth.pdf", "pictures.pdf",
            "distance_over_seconds.pdf", "distance_over_iterations.csv", "distance_own_over_seconds.png", "distance_own_over_iterations.pdf"} <= set(files)
    words = re.findall(r"<text[^>]*>([^<]*)</text>", files["distance_own_over_seconds.svg"].read_text())  # a title of two lines is two texts
    assert "distance from its own end" in " ".join(words)
    drawn = rows_of(files["seconds_by_step_growth.csv"])
    assert len(drawn) == 4 and all(float(row["low"]) <= float(row["median"]) <= float(row["high"]) and row["count"] == "2" for row in drawn)
    captions = files["figures.tex"].read_text()
    assert set(re.findall(r"{([^{}]+\.pdf)}", captions)) == {name for name in files if name.endswith(".pdf")} and "Measured by drape " in captions
    assert "Bold: " in files["table.tex"].read_text() or r"\textbf" not in files["table.tex"].read_text()
    rows = rows_of(files["table.csv"])
    assert len(rows) == 8 and {float(row["newton.step_growth"]) for row in rows} == {1.5, 3}
    assert r"step growth & method & converged" in files["table.tex"].read_text()
    assert r"1.5 & pcs & 2 of 2 & " in files["table.tex"].read_text()
    check_latex(files["table.tex"].read_text())


@pytest.mark.parametrize("grid, plots, says", [
    ("newton.step_size: [0.1, 0.2], methods.newton.newton.step_size: [0.1, 0.2]",  # two keys with one last part
     ["seconds_by_newton_step_size.svg", "seconds_by_methods_newton_newton_step_size.svg"], ""),
    ("material.warp_bending: [null, 1e-6]", ["seconds_by_warp_bending.svg"], ">--<"),
])
def test_every_varied_key_has_a_plot_with_all_of_its_values(written, swept, grid, plots, says):
    files = written(swept(f"ablation: {{grid: {{{grid}}}}}"))
    assert set(plots) <= set(files)
    assert says in files[plots[0]].read_text()


def test_what_has_no_results_has_no_figures(swept, tmp_path):
    sweep = swept(GRID + NOTHING_PINNED, code=1)
    for folder, why in ((sweep, "no run has written results yet"), (tmp_path, "neither results.json nor sweep.json here")):
        assert why in command("figures", folder, "-o", tmp_path / "out", code=2).stderr


def test_runs_without_results_are_in_the_tables(written, swept):
    files = written(swept(f"ablation: [{{name: whole}}, {{name: far, {NOTHING_PINNED}}}]", code=1))
    assert len(rows_of(files["table.csv"])) == 6
    assert " & -- & 0 of 2 & " in files["table.tex"].read_text()
    check_latex(files["table.tex"].read_text())


def test_figures_have_the_measures_methods_width_and_style_that_are_asked_for(swept, tmp_path):
    (tmp_path / "mine.mplstyle").write_text("axes.prop_cycle: cycler('color', ['112233'])\nfont.size: 11\n")
    sweep = swept(GRID)
    for asked in ("--measures=speed", "--methods=multigrid"):
        assert f'there is no {asked[2:].split("s=")[0]} "' in command("figures", sweep, "-o", tmp_path / "out", asked, code=2).stderr
    assert "none_such" in command("figures", sweep, "-o", tmp_path / "out", "--style", "none_such", code=2).stderr
    assert "nothing is downloaded" in command("figures", sweep, "-o", tmp_path / "out", "--style", "http://localhost:9/a.mplstyle", code=2).stderr
    command("figures", sweep, "-o", tmp_path / "out", "--measures", "seconds", "--methods", "pcs", "--width", "100", "--log", "--style", tmp_path / "mine.mplstyle")
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert "seconds_by_step_growth.svg" in names and not any(name.startswith("iterations_by") for name in names)
    svg = (tmp_path / "out/seconds_by_step_growth.svg").read_text()
    assert "#112233" in svg and "newton<" not in svg and 'width="283' in svg  # 100 mm in points
    assert {row["method"] for row in rows_of(tmp_path / "out/seconds_by_step_growth.csv")} == {"pcs"}


def test_scenes_are_not_joined_and_stand_in_the_order_of_the_file(written, swept):
    files = written(swept("ablation: {grid: {refiner: [midpoint, loop]}}"))
    rows = rows_of(files["error_rms_by_refiner.csv"])
    assert [row["refiner"] for row in rows] == ["midpoint", "loop"] * 2
    reference = [row for row in rows if row["method"] == "newton"]
    assert all(row["reference"] == "2" and row["median"] == "" for row in reference) and ">reference<" in files["error_rms_by_refiner.svg"].read_text()


def test_only_an_error_is_absent_because_its_method_is_the_reference():
    row = {"scene": "square", "method": "newton", "starts": 3, "converged": "3 of 3", "reference": 1, "smallest_gap": None, "error_rms": None}
    summary, look = pandas.DataFrame([row]), {"newton": {"color": "black", "marker": "o", "linestyle": "-"}}
    for measure, why in (("error_rms", "reference"), ("smallest_gap", "--")):
        figure, _ = paper_sweep.measure_figure(summary, measure, measure, "scene", paper_sweep.Keys({"scene": ""}), look)
        assert [text.get_text() for text in figure.axes[0].texts] == [why]


def test_numbers_are_written_where_there_is_room_and_the_reference_is_named(written, swept):
    files = written(swept("ablation: {grid: {refiner: [midpoint, loop]}}"))
    numbers = {paper_sweep.digits(float(row["median"])) for row in rows_of(files["iterations_by_refiner.csv"])}
    assert all(f">{number}<" in files["iterations_by_refiner.svg"].read_text() for number in numbers)
    for cost in ("seconds", "iterations"):
        assert ">reference: newton in 2 of 2<" in files[f"distance_over_{cost}.svg"].read_text()
    assert re.search(r">0\.\d+K vertices, [\d.e-]+ CPU s<", files["pictures.svg"].read_text())


def test_a_sweep_from_python_is_that_of_the_command_and_runs_what_is_missing(tmp_path):
    experiment = drape.Experiment(SMALL_FILE)
    ask = dict(methods=["pcs"], out=tmp_path / "sweep", progress=False)
    frame = drape.sweep(experiment, {"newton.step_growth": [1.5]}, 2, **ask)
    assert len(frame) == 2 and set(frame["seed"]) == {1, 2}
    before = (tmp_path / "sweep/runs/step_growth=1.5/seed_1/results.json").stat().st_mtime_ns
    frame = drape.sweep(experiment, {"newton.step_growth": [1.5, 3]}, 2, **ask)
    assert len(frame) == 4 and set(frame["newton.step_growth"]) == {1.5, 3}
    assert (tmp_path / "sweep/runs/step_growth=1.5/seed_1/results.json").stat().st_mtime_ns == before
    with pytest.raises(RuntimeError, match="unknown key"):
        drape.sweep(experiment, {"newton.step_grwth": [1]}, 2, methods=["pcs"], out=tmp_path / "other", progress=False)
    with pytest.raises(RuntimeError, match='"repeats" must be at most 10000'):
        drape.sweep(experiment, starts=10**9, methods="pcs", out=tmp_path / "other", progress=False)
    assert set(drape.sweep(experiment, methods="newton", out=tmp_path / "one", progress=False)["method"]) == {"newton"}
    assert drape.figures(tmp_path / "sweep", tmp_path / "figures")


@pytest.mark.parametrize("values", [(0.9, 1.1), (1.5, 7), (0.8, 8), (3, 200), (2e-4, 90), (1e-9, 1e3)])
def test_a_logarithmic_axis_has_labels_enough_to_be_read(values):
    import matplotlib.pyplot

    figure, axes = matplotlib.pyplot.subplots(figsize=(3.3, 2.4))
    axes.plot(values, values)
    axes.set(xscale="log", yscale="log")
    for axis in (axes.xaxis, axes.yaxis):
        plots.label_logarithmic(axis)
    figure.canvas.draw()
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        labels = [label.get_text() for place, label in zip(axis.get_majorticklocs(), axis.get_majorticklabels()) if low <= place <= high]
        assert 2 <= len(labels) == len(set(labels)) <= 13 and all(labels)
    matplotlib.pyplot.close(figure)


def test_titles_of_panels_are_one_line_where_smaller_type_makes_them_that():
    import matplotlib.pyplot

    for title, size, lines in (("friction 0.1", 8, 1), ("bending modulus 80000 Pa, membrane modulus 1e5 Pa", 6, 1), ("word " * 20, 8, 3)):
        figure, panels, _ = paper_sweep._panels([title] * 3, None, 50)
        assert {panel.get_title().count("\n") + 1 for panel in panels} == {lines}
        assert {panel.title.get_fontsize() for panel in panels} == {size if size < 8 else matplotlib.rcParams["axes.titlesize"]} or size == 8
        matplotlib.pyplot.close(figure)


def test_a_map_goes_by_what_names_it_and_else_by_its_number():
    twill, one, other = (f'{{"file":"{file}.csv","row":"{row}"}}' for file, row in (("mine", "twill-300"), ("mine", "x"), ("theirs", "x")))
    keys = paper_sweep.Keys({"fabric": ""}, [{"fabric": value} for value in ("cotton", twill, one, other)])
    assert [keys.value("fabric", value) for value in ("cotton", twill, one, other)] == ["cotton", "twill-300", "2", "3"]
    assert keys.text("fabric", twill) == "fabric twill-300"


def test_figures_evaluate_no_style_of_the_working_folder(tmp_path, monkeypatch):
    command("run", SMALL_FILE, "-o", tmp_path / "run", "--no-report", "-q")
    write = "x.gi_frame.f_back.f_back.f_back.f_builtins['open']('evaluated', 'w')"
    (tmp_path / "matplotlibrc").write_text(f"axes.linewidth: 20\naxes.prop_cycle: cycler(color=[[h:=[], h.append({write} for x in h), h.append(h[0]), [*h[0]]] and 'k'])\n")
    monkeypatch.chdir(tmp_path)
    command("figures", "run", "-o", "made")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["made", "matplotlibrc", "run"]
    assert "stroke-width: 20" not in (tmp_path / "made/convergence.svg").read_text()


def test_names_in_the_results_of_others_lead_nowhere(tmp_path):
    command("run", SMALL_FILE, "-o", tmp_path / "run", "--no-report", "-q", "--measure")
    results = json.loads((tmp_path / "run/results.json").read_text())
    results["methods"][f"/{tmp_path}/\x1b[2J"] = next(iter(results["methods"].values()))
    (tmp_path / "run/results.json").write_text(json.dumps(results))
    said = command("figures", tmp_path / "run", "-o", tmp_path / "made").stdout
    assert "_end.png" in said and "\x1b" not in said
    assert sorted(file.name for file in tmp_path.iterdir()) == ["made", "run"]


def test_figures_that_cannot_all_be_written_are_no_refusal(tmp_path):
    command("run", SMALL_FILE, "-o", tmp_path / "run", "--no-report", "-q", "--measure")
    (tmp_path / "made").mkdir()
    call = """if True:
        import resource
        import drape.paper as paper
        write = paper._core._write_file
        def limited(*given):
            resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000))
            write(*given)
        paper._core._write_file = limited
        raise SystemExit(paper.main())
    """
    ended = subprocess.run([sys.executable, "-c", call, tmp_path / "run", "-o", tmp_path / "made"], capture_output=True, text=True)
    assert ended.returncode == 3 and ended.stderr.startswith("error: cannot write ")
    assert (tmp_path / "made/table.csv").exists()


def test_the_system_s_error_is_told_not_what_follows_from_it(tmp_path):
    command("run", SMALL_FILE, "-o", tmp_path / "run", "--no-report", "-q", "--measure")
    call = "import resource, drape.paper; resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000)); raise SystemExit(drape.paper.main())"
    ended = subprocess.run([sys.executable, "-c", call, tmp_path / "run", "-o", tmp_path / "made"], capture_output=True, text=True)
    assert ended.returncode == 2 and ended.stderr == "error: a file cannot be written: File too large\n"
