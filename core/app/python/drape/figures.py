"""What `drape figures RESULTS -o DIR` writes: a paper's plots (SVG, PNG), tables (CSV, LaTeX) and pictures of states.

The plots are Result's, in matplotlib's current style: a matplotlibrc in the working folder restyles them all.
"""

from __future__ import annotations

import argparse
import pathlib
import sys
import tempfile

import pandas

from . import _core
from .plots import measures_of
from .result import read_run, read_sweep

# Columns of the LaTeX table beside what tells its rows apart, in order, as far as the runs have them.
COLUMNS = {"preview_seconds": "preview [s]", "seconds": "end [s]", "iterations": "Newton iterations", "preview_rms": "preview error", "error_rms": "error",
           "energy_released": "energy released [J]", "intersections": "intersections"}
ESCAPES = str.maketrans({c: "\\" + c for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"})


def _converged(rows: pandas.DataFrame) -> pandas.DataFrame:
    # A method whose levels ended differently has the status of each: "converged, max_steps_reached".
    return rows[[all(word.startswith("converged") for word in str(status).split(", ")) for status in rows["status"]]]


def _digits(value: float) -> str:
    text = f"{value:.3g}"
    if "e" not in text:
        return text
    digits, power = text.split("e")
    return rf"${digits}\cdot10^{{{int(power)}}}$"


def _latex_cell(values: pandas.Series) -> str:
    if values.notna().sum() == 0:
        return "--"
    median, low, high = (_digits(value) for value in (values.median(), values.min(), values.max()))
    return median if low == high else f"{median} ({low} -- {high})"


def _varied(rows: pandas.DataFrame) -> list[str]:
    """The keys that a sweep varies: the table has them between the run's name and its seed."""
    names = list(rows)
    keys = [name for name in names[names.index("run") + 1:names.index("seed" if "seed" in names else "method")] if rows[name].nunique(dropna=False) > 1]
    return keys or (["run"] if rows["run"].nunique() > 1 else [])


def _groups(rows: pandas.DataFrame, keys: list[str]):
    """Pairs of the keys' values and the rows with them, in the order of their first rows."""
    for values, group in rows.groupby(keys if len(keys) > 1 else keys[0], sort=False, dropna=False):
        yield values if len(keys) > 1 else (values,), group


def latex_table(rows: pandas.DataFrame) -> str:
    """Medians over the starts that converged, with ranges, for the package booktabs."""
    keys = [*_varied(rows), "method"]
    columns = {name: title for name, title in COLUMNS.items() if name in rows and rows[name].notna().any()}
    head = [key.rsplit(".", 1)[-1] for key in keys] + ["converged", *columns.values()]
    lines = [rf"\begin{{tabular}}{{{'l' * len(keys)}{'r' * (len(columns) + 1)}}}", r"\toprule",
             " & ".join(name.translate(ESCAPES) for name in head) + r" \\", r"\midrule"]
    for values, group in _groups(rows, keys):
        good = _converged(group)
        cells = [("--" if pandas.isna(value) or value == "" else str(value)).translate(ESCAPES) for value in values]
        cells += [f"{len(good)} of {len(group)}"] + [_latex_cell(good[name]) for name in columns]
        lines.append(" & ".join(cells) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}", ""])


def _save(axes, file: pathlib.Path) -> list[pathlib.Path]:
    files = [file.with_suffix(ending) for ending in (".svg", ".png")]
    for each in files:
        axes.figure.savefig(each, bbox_inches="tight", dpi=200, metadata={"Date": None} if each.suffix == ".svg" else None)
    return files


def _run_figures(folder: pathlib.Path, out: pathlib.Path) -> list[pathlib.Path]:
    result = read_run(folder)
    files = _save(result.plot_convergence(), out / "convergence")
    for target in ("own", "reference"):
        if measures_of(result.errors, target):
            files += _save(result.plot_errors(target=target), out / f"distance_{target}")
    if len(result.errors):
        (out / "errors.csv").write_bytes((folder / "errors.csv").read_bytes())
        files.append(out / "errors.csv")
    for method in result.methods:
        levels = [entry.level for entry in result[method].levels if vars(entry).get("mesh")]
        pictures: dict[str, dict] = {"end": {}}
        if len(levels) > 1:
            pictures |= {"preview": {"level": levels[0]}, "outline": {"outline": True}}
        for name, options in pictures.items() if levels else ():
            files.append(out / f"{method}_{name}.png")
            _core._draw(folder, files[-1], method, **options)
    return files


def _sweep_figures(rows: pandas.DataFrame, out: pathlib.Path) -> list[pathlib.Path]:
    """Each quantity against each varied key: medians with ranges, a line for each method and value of the other keys."""
    import matplotlib.pyplot

    files, keys = [], _varied(rows)
    last = [key.rsplit(".", 1)[-1] for key in keys]
    short = {key: word if last.count(word) == 1 else key.replace(".", "_") for key, word in zip(keys, last)}
    good = _converged(rows)
    for name, title in COLUMNS.items():
        for key in keys if name in rows and rows[name].notna().any() else ():
            axes = matplotlib.pyplot.subplots()[1]
            types = pandas.api.types  # null and booleans have no place on an axis of numbers
            numeric = types.is_numeric_dtype(rows[key]) and not types.is_bool_dtype(rows[key]) and rows[key].notna().all()
            for label, group in _groups(good, [*(k for k in keys if k != key), "method"]):
                spread = group.groupby(key, dropna=False)[name].agg(["median", "min", "max"]).dropna()
                x = spread.index if numeric else ["--" if pandas.isna(value) else str(value) for value in spread.index]
                ranges = [spread["median"] - spread["min"], spread["max"] - spread["median"]]
                axes.errorbar(x, spread["median"], yerr=ranges, marker="o", markersize=4, capsize=3, label=", ".join(map(str, label)))
            if numeric and rows[key].min() > 0 and rows[key].max() > 20 * rows[key].min():
                axes.set_xscale("log")
            axes.set(xlabel=key, ylabel=title)
            axes.legend(fontsize="small")
            files += _save(axes, out / f"{name}_by_{short[key]}")
            matplotlib.pyplot.close(axes.figure)
    return files


def _cell(value):
    return _core._uncomputed(value) if isinstance(value, str) else value


def figures(results, out, overwrite: bool = False) -> list[pathlib.Path]:
    """Writes the figures of a run or a sweep to a folder, which is made, and returns the files. Raises RuntimeError for a
    folder without results, and for a file that exists."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "drape"})  # texts stay texts; equal runs give equal files
    folder, out = pathlib.Path(results), pathlib.Path(out)
    rows = read_sweep(folder)
    if "method" not in rows or (rows["method"].fillna("") == "").all():  # a run without results has no method
        raise RuntimeError(f"{folder}: no run has written results yet")
    out.mkdir(parents=True, exist_ok=True)
    _core._refuse_target(out / "table.csv", overwrite)  # before anything is drawn
    with tempfile.TemporaryDirectory(prefix="drape_figures_") as made:
        files = [pathlib.Path(made, "table.csv"), pathlib.Path(made, "table.tex")]
        rows.apply(lambda column: column.map(_cell)).to_csv(files[0], index=False)
        files[1].write_text(latex_table(rows), encoding="utf-8")
        of_run = (folder / "results.json").exists()
        files += _run_figures(folder, pathlib.Path(made)) if of_run else _sweep_figures(rows, pathlib.Path(made))
        written = [out / file.name for file in files]
        for target in written:
            _core._refuse_target(target, overwrite)
        for file, target in zip(files, written):
            _core._write_file(target, file.read_bytes(), overwrite)
    return written


def main() -> int:
    parser = argparse.ArgumentParser(prog="drape figures", description=__doc__)
    parser.add_argument("results", help="results folder of a run, or a sweep's")
    parser.add_argument("-o", "--out", required=True, help="folder of the figures")
    parser.add_argument("--overwrite", action="store_true", help="replace existing files")
    arguments = parser.parse_args()
    try:
        for file in figures(arguments.results, arguments.out, arguments.overwrite):
            print(file)
    except (RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
