"""What `drape figures RESULTS -o DIR` writes: a paper's figures (PDF, SVG, PNG, each with its CSV), tables (CSV, LaTeX) and pictures.

The style is plots.STYLE, under the reader's own: matplotlib's matplotlibrc, or --style.
"""

from __future__ import annotations

import argparse
import itertools
import json
import pathlib
import re
import sys
import tempfile
import textwrap

import pandas

from . import _core, paper_sweep
from .plots import COSTS, measures_of, use_style
from .result import read_run, read_sweep

# Columns of the LaTeX table and figures, beside what tells their rows apart, in order, as far as the runs have them.
COLUMNS = {"vertices": "vertices", "preview_seconds": "preview [s]", "seconds": "end [s]", "cpu_seconds": "CPU time [s]", "iterations": "Newton iterations",
           "preview_rms": "preview from its end [diagonal]", "error_rms": "end from the reference [diagonal]",
           "energy_released": "energy released [J]", "intersections": "intersections"}
TOLD = ("vertices", "energy_released", "intersections")  # by the table alone: methods differ in digits that no plot shows
ESCAPES = str.maketrans({c: "\\" + c for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"})


def _digits(value: float) -> str:
    text, *power = paper_sweep.digits(value).split("e")
    return rf"${text}\cdot10^{{{int(power[0])}}}$" if power else text


def _latex_cell(name: str, row) -> tuple[str, str]:
    """The median, and what stands below it."""
    spread = row[name]
    if not isinstance(spread, dict):
        return "reference" if paper_sweep.is_error(name) and row["reference"] else "--", ""
    median, low, high = (_digits(spread[part]) for part in ("median", "low", "high"))
    parts = [median, f"{low}--{high}" if low != high else ""]
    notes = [f"$n={spread['count']}$"] * (spread["count"] < row["starts"])
    median, spread = (rf"\textbf{{{part}}}" if part and name in row["best"] else part for part in parts)
    return median, rf"{{\scriptsize {', '.join(filter(None, [spread, *notes]))}}}" if spread or notes else ""


def _title(measure: str, table: dict) -> str:
    unit = table["metric_units"].get(measure)
    return COLUMNS.get(measure, measure.replace("_", " ") + (f" [{unit}]" if unit else ""))


def _varied(table: dict) -> list[str]:
    """The keys that a sweep varies, or the run's name where only that differs."""
    summary = pandas.DataFrame(table["summary"])
    keys = [key for key in table["units"] if summary[key].map(str).nunique() > 1]
    return keys or (["variation"] if summary["variation"].nunique() > 1 else [])


def latex_table(table: dict, measures=(), machine: str = "") -> str:
    """Medians over the starts that converged, with ranges below, no wider than the text, for the packages booktabs and graphicx; what is bold is
    the pages' choice."""
    summary, keys = pandas.DataFrame(table["summary"]), _varied(table)
    names = paper_sweep.Keys({key: table["units"].get(key, "") for key in keys}, table["summary"])
    columns = {name: _title(name, table) for name in measures or COLUMNS if name in summary and summary[name].notna().any()}
    has_reference = any(0 < row["reference"] < row["starts"] for _, row in summary.iterrows())  # else the errors' cells say it all
    head = [*(names.title(key) for key in keys), "method", "converged", *["reference"] * has_reference, *columns.values()]
    stacked = [textwrap.fill(title.translate(ESCAPES), 14).replace("\n", r"\\{}") for title in head]
    stacked = [rf"\shortstack[r]{{{title}}}" if r"\\" in title else title for title in stacked]
    lines = [r"\small\setlength{\tabcolsep}{4pt}\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{",
             rf"\begin{{tabular}}{{{'l' * (len(keys) + 1)}{'r' * (len(head) - len(keys) - 1)}}}", r"\toprule", " & ".join(stacked) + r" \\"]
    former: list | None = None
    for _, row in summary.iterrows():
        where = [names.value(key, row[key]).translate(ESCAPES) for key in keys]
        lines.append(r"\midrule" if former is None or where[:1] != former[:1] else r"\addlinespace")
        said = [word if former is None or where[:k + 1] != former[:k + 1] else "" for k, word in enumerate(where)]
        medians, below = zip(*(_latex_cell(name, row) for name in columns)) if columns else ((), ())
        said += [row["method"].translate(ESCAPES) or "--", row["converged"], *[f"{row['reference']} of {row['starts']}"] * has_reference]
        lines.append(" & ".join([*said, *medians]) + r" \\")
        lines += [" & ".join([""] * (len(head) - len(columns)) + list(below)) + r" \\"] if any(below) else []
        former = where
    timed = [row for row in table["rows"] if row["method"]]
    busy = sum(row["machine"] == "busy" for row in timed)
    notes = ["Medians over the starts that converged, with ranges; $n$ where it is not all of them."]
    notes += [table["bold"].translate(ESCAPES)] if any(summary["best"].map(len)) else []
    notes += [machine.translate(ESCAPES)] if machine else []
    notes += [f"The machine was busy during {busy} of {len(timed)} timings."] if busy else []
    return "\n".join([r"\begingroup", *lines, r"\bottomrule", r"\end{tabular}", r"}\endgroup", r"\par\smallskip{\footnotesize " + " ".join(notes) + "}", ""])


def _file(folder: pathlib.Path, name: str) -> pathlib.Path:
    """A file in the folder, whatever names of methods and measures the results of somebody else have."""
    return folder / re.sub(r"[^\w.,=+-]", "_", name)


def _save(figure, rows: pandas.DataFrame, file: pathlib.Path) -> list[pathlib.Path]:
    """The figure as PDF, SVG and PNG, and what it shows as CSV. Equal figures give equal files."""
    import matplotlib.pyplot

    files = [file.with_suffix(ending) for ending in (".pdf", ".svg", ".png", ".csv")]
    figure.canvas.draw()
    figure.set_layout_engine("none")  # as it is laid out now
    for each in files[:3]:
        figure.savefig(each, metadata={".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(each.suffix))
    rows.apply(lambda column: column.map(_cell)).rename(columns=_cell).to_csv(files[3], index=False)
    matplotlib.pyplot.close(figure)
    return files


def _run_figures(folder: pathlib.Path, out: pathlib.Path) -> list[pathlib.Path]:
    result = read_run(folder)
    files = _save(result.plot_convergence().figure, result.iterations, out / "convergence")
    for target in ("own", "reference"):
        if measures_of(result.errors, target):
            files += _save(result.plot_errors(target=target).figure, result.errors, out / f"distance_{target}")
    if len(result.errors):
        (out / "errors.csv").write_bytes((folder / "errors.csv").read_bytes())
        files.append(out / "errors.csv")
    for method in result.methods:
        levels = [entry.level for entry in result[method].levels if vars(entry).get("mesh")]
        pictures: dict[str, dict] = {"end": {}}
        if len(levels) > 1:
            pictures |= {"preview": {"level": levels[0]}, "outline": {"outline": True}}
        for name, options in pictures.items() if levels else ():
            files.append(_file(out, f"{method}_{name}.png"))
            _core._draw(folder, files[-1], method, **options)
    return files


def _measured_by(folders) -> str:
    """The program and the machines of runs, as results.json has them, in a sentence for tables and captions."""
    said = []
    for folder in folders:
        record = json.loads((folder / "results.json").read_text(encoding="utf-8"))
        machine = record.get("machine") or {}
        threads = machine.get("threads", 1)
        parts = (f"{record.get('version', 'drape')} ({str(record.get('commit', ''))[:8]})", machine.get("cpu"), f"{threads} thread" + "s" * (threads != 1))
        said.append(", ".join(filter(None, parts)))
    return f"Measured by {'; '.join(dict.fromkeys(said))}."


def _sweep_figures(table: dict, run_folders: dict, out: pathlib.Path, measures, methods, width, log, machine: str) -> list[pathlib.Path]:
    """Each measure against each varied key; distance against time and iterations; previews and ends side by side; and, in
    figures.tex, all of them with their captions."""
    files, captions, keys = [], [], _varied(table)
    names = paper_sweep.Keys({key: table["units"].get(key, "") for key in keys}, table["summary"])
    summary = pandas.DataFrame(row for row in table["summary"] if row["method"] and (not methods or row["method"] in methods))
    styles = paper_sweep.styles_of(summary)
    busy = any(row.get("machine") == "busy" for row in table["rows"])

    def save(made, name: str, caption: str) -> None:
        figure, rows = made
        files.extend(_save(figure, rows, _file(out, name)))
        wide, text = figure.get_figwidth() / paper_sweep.MILLIMETRE, f"{caption} {machine}".translate(ESCAPES)
        captions.append(rf"\begin{{figure}}\centering\includegraphics[width={wide:.0f}mm]{{{files[-1].stem}.pdf}}\caption{{{text}}}\label{{fig:{files[-1].stem}}}\end{{figure}}")

    for name in measures or [name for name in COLUMNS if name not in TOLD and name in summary and summary[name].notna().any()]:
        title = _title(name, table) + (", on a busy machine" if busy and name in ("seconds", "preview_seconds") else "")
        for key in keys:
            save(paper_sweep.measure_figure(summary, name, title, key, names, styles, width, log), f"{name}_by_{names.short(key)}",
                 f"{title[0].upper() + title[1:]}, by {names.title(key)}: medians over the starts that converged, with ranges; n where it is not all of them.")
    titles = {row["variation"]: ", ".join(names.text(key, row[key]) for key in keys) or row["variation"] for _, row in summary.iterrows()}
    runs: dict = {}
    for run, variation in run_folders.items():
        if variation in titles:
            runs.setdefault(titles[variation], []).append(read_run(run))
    references = {title: ", ".join(f"{row['method']} in {row['reference']} of {row['starts']}" for _, row in summary.iterrows()
                                   if row["variation"] == variation and row["reference"]) for variation, title in titles.items()}
    drawn = paper_sweep.draw_states(runs, list(styles), width)
    columns = paper_sweep.error_columns(runs)
    for column, cost in itertools.product(columns, ("seconds", "iterations")):
        if made := paper_sweep.distance_figure(runs, column, cost, styles, references, drawn, width, busy):
            of_reference = column.startswith("reference")
            target = "the reference" if of_reference else "its own end"
            note = "Where a method's own end is the reference, its line falls to nothing. " if of_reference and any(references.values()) else ""
            save(made, f"distance_{'' if column == columns[0] else 'own_'}over_{cost}", f"Distance of each method's states from {target} against {COSTS[cost]}: "
                 f"medians over the starts, with bands from the lowest to the highest. {note}Pictures: the end from the first start.")
    if made := paper_sweep.pictures_figure(drawn, styles, width):
        save(made, "pictures", "Preview and end of each method from the first start, by one camera, with vertices and CPU time up to that state.")
    files.append(out / "figures.tex")
    files[-1].write_text("\n\n".join(captions) + "\n", encoding="utf-8")
    return files


def _cell(value):
    return _core._uncomputed(value) if isinstance(value, str) else value


def figures(results, out, overwrite: bool = False, *, measures=(), methods=(), width=None, log: bool = False, style: str = "") -> list[pathlib.Path]:
    """Writes the figures of a run or a sweep to a folder, which is made, and returns the files. Raises RuntimeError for a
    folder without results, for a file that exists, and for a measure or a method that the results do not have.

    measures, methods: of a sweep's figures and of table.tex, by their names in `drape table`; COLUMNS, and all methods, by default.
    width: of a figure in mm; by default 84, and 174 of one with several panels. log: logarithmic measures.
    style: a matplotlib style, by its name or file.
    """
    import matplotlib

    matplotlib.use("Agg")
    folder, out = pathlib.Path(results), pathlib.Path(out)
    rows, table = read_sweep(folder), json.loads(_core._summary(folder))
    if not any(row["method"] for row in table["summary"]):  # a run without results has no method
        raise RuntimeError(f"{folder}: no run has written results yet")
    for what, asked, known in (("measure", measures, [name for name, value in table["summary"][0].items() if isinstance(value, (dict, type(None)))]),
                               ("method", methods, list(dict.fromkeys(row["method"] for row in table["summary"] if row["method"])))):
        for name in asked:
            if name not in known:
                raise RuntimeError(f"there is no {what} \"{name}\"; there are {', '.join(known)}")
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RuntimeError(f"{out}: cannot be made ({error.strerror}); name another folder") from error
    _core._refuse_target(out / "table.csv", overwrite)  # before anything is drawn
    with matplotlib.rc_context(), tempfile.TemporaryDirectory(prefix="drape_figures_") as made:
        use_style(style, width)
        files = [pathlib.Path(made, "table.csv"), pathlib.Path(made, "table.tex")]
        rows.apply(lambda column: column.map(_cell)).to_csv(files[0], index=False)
        of_run = (folder / "results.json").exists()
        runs = {folder: ""} if of_run else {folder / run["folder"]: run["name"] for run in json.loads((folder / "sweep.json").read_text(encoding="utf-8"))["runs"]
                                            if (folder / run["folder"] / "results.json").exists()}
        machine = _measured_by(runs)
        files[1].write_text(latex_table(table, measures, machine), encoding="utf-8")
        files += _run_figures(folder, pathlib.Path(made)) if of_run else _sweep_figures(table, runs, pathlib.Path(made), measures, methods, width, log, machine)
        written = [out / file.name for file in files]
        for target in written:
            _core._refuse_target(target, overwrite)
        try:
            for file, target in zip(files, written):
                _core._write_file(target, file.read_bytes(), overwrite)
        except RuntimeError as error:  # as on a full disk
            raise _core.RunAborted(str(error)) from None
    return written


def _printable(text) -> str:
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))


def main() -> int:
    parser = argparse.ArgumentParser(prog="drape figures", description=__doc__)
    parser.add_argument("results", help="results folder of a run, or a sweep's")
    parser.add_argument("-o", "--out", required=True, help="folder of the figures")
    parser.add_argument("--overwrite", action="store_true", help="replace existing files")
    for name in ("measures", "methods"):
        parser.add_argument(f"--{name}", type=lambda text: [word for word in text.split(",") if word], default=[])
    parser.add_argument("--width", type=float, help="width of a figure [mm]")
    parser.add_argument("--log", action="store_true", help="logarithmic measures")
    parser.add_argument("--style", default="", help="a matplotlib style: its name, or a file")
    given = vars(parser.parse_args())
    try:
        for file in figures(given.pop("results"), given.pop("out"), given.pop("overwrite"), **given):
            print(_printable(file))
    except Exception as error:  # of pandas and matplotlib too: of names and numbers that no run writes
        cause: BaseException | None = error
        while cause and not isinstance(cause, (RuntimeError, OSError)):  # others follow from it, as of a stream that a full disk cut
            cause = cause.__cause__ if cause.__suppress_context__ else cause.__context__
        if isinstance(cause, OSError) and cause.strerror and not cause.filename:
            reason = f"a file cannot be written: {cause.strerror}"
        else:
            reason = str(cause or f"the results are not as drape writes them ({type(error).__name__}: {error})")
        print("error: " + _printable(reason.replace("overwrite=True", "--overwrite")), file=sys.stderr)
        return 3 if isinstance(error, _core.RunAborted) else 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
