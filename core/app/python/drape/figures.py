"""What `drape figures RESULTS -o DIR` writes: a paper's plots (SVG, PNG), tables (CSV, LaTeX) and pictures of states.

The plots are Result's, in matplotlib's current style: a matplotlibrc in the working folder restyles them all.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

import numpy

from . import _core
from .result import read_run

# Columns of the LaTeX table beside what tells its rows apart, in order, as far as the runs have them.
COLUMNS = {"preview_seconds": "preview [s]", "seconds": "end [s]", "preview_rms": "preview error", "error_rms": "error",
           "energy_released": "energy released [J]", "intersections": "intersections"}
ESCAPES = str.maketrans({c: "\\" + c for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"})


def _spread(values) -> tuple | None:
    """Median and extremes of the known values."""
    known = [value for value in values if value is not None]
    return (float(numpy.median(known)), min(known), max(known)) if known else None


def _converged(row) -> bool:
    return row["status"].startswith("converged")


def _digits(value: float) -> str:
    text = f"{value:.3g}"
    if "e" not in text:
        return text
    digits, power = text.split("e")
    return rf"${digits}\cdot10^{{{int(power)}}}$"


def _latex_cell(values) -> str:
    spread = _spread(values)
    if spread is None:
        return "--"
    median, low, high = map(_digits, spread)
    return median if low == high else f"{median} ({low} -- {high})"


def _varied(rows) -> list[str]:
    """The keys that a sweep varies: the table has them between the run's name and its seed."""
    names = list(rows[0])
    keys = [name for name in names[names.index("run") + 1:names.index("seed")] if len({row[name] for row in rows}) > 1]
    return keys or (["run"] if len({row["run"] for row in rows}) > 1 else [])


def _groups(rows, keys) -> dict:
    groups: dict = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def latex_table(rows) -> str:
    """Medians over the starts that converged, with ranges, for the package booktabs."""
    keys = [*_varied(rows), "method"]
    columns = {name: title for name, title in COLUMNS.items() if any(row.get(name) is not None for row in rows)}
    head = [key.rsplit(".", 1)[-1] for key in keys] + ["converged", *columns.values()]
    lines = [rf"\begin{{tabular}}{{{'l' * len(keys)}{'r' * (len(columns) + 1)}}}", r"\toprule",
             " & ".join(name.translate(ESCAPES) for name in head) + r" \\", r"\midrule"]
    for values, group in _groups(rows, keys).items():
        good = [row for row in group if _converged(row)]
        cells = [str("--" if value is None else value).translate(ESCAPES) for value in values]
        cells += [f"{len(good)} of {len(group)}"] + [_latex_cell(row.get(name) for row in good) for name in columns]
        lines.append(" & ".join(cells) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}", ""])


def _write_csv(file: pathlib.Path, rows) -> None:
    with file.open("w", newline="", encoding="utf-8") as out:
        writer = csv.DictWriter(out, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def _save(axes, file: pathlib.Path) -> list[pathlib.Path]:
    files = [file.with_suffix(ending) for ending in (".svg", ".png")]
    for each in files:
        axes.figure.savefig(each, bbox_inches="tight", dpi=200, metadata={"Date": None} if each.suffix == ".svg" else None)
    return files


def _run_figures(folder: pathlib.Path, out: pathlib.Path, drape: str) -> list[pathlib.Path]:
    result = read_run(folder)
    files = _save(result.plot_convergence(), out / "convergence")
    for target in ("own", "reference"):
        if any(name.startswith(target + "_") and not numpy.all(numpy.isnan(result.errors[name])) for name in result.errors):
            files += _save(result.plot_errors(target=target), out / f"distance_{target}")
    if result.errors.row_count:
        (out / "errors.csv").write_bytes((folder / "errors.csv").read_bytes())
        files.append(out / "errors.csv")
    for method in result.methods:
        levels = [entry.level for entry in result[method].levels]
        pictures: dict[str, list[str]] = {"end": []}
        if len(levels) > 1:
            pictures |= {"preview": ["--level", str(levels[0])], "outline": ["--outline"]}
        for name, options in pictures.items() if levels else ():
            files.append(out / f"{method}_{name}.png")
            subprocess.run([drape, "export", folder, "--to", files[-1], "--method", method, "--overwrite", *options],
                           check=True, stdout=subprocess.DEVNULL)
    return files


def _sweep_figures(rows, out: pathlib.Path) -> list[pathlib.Path]:
    """Each quantity against each varied key: medians with ranges, a line for each method and value of the other keys."""
    import matplotlib.pyplot

    files, keys = [], _varied(rows)
    for name, title in COLUMNS.items():
        for key in keys if any(row.get(name) is not None for row in rows) else ():
            axes = matplotlib.pyplot.subplots()[1]
            values = sorted({row[key] for row in rows}, key=lambda v: (isinstance(v, str), v if v is not None else ""))
            numeric = all(isinstance(value, (int, float)) for value in values)
            for label, group in _groups(rows, [*(k for k in keys if k != key), "method"]).items():
                spreads = [_spread(row.get(name) for row in group if row[key] == value and _converged(row)) for value in values]
                points = [(value if numeric else str(value), *spread) for value, spread in zip(values, spreads) if spread]
                if points:
                    x, median, low, high = zip(*points)
                    ranges = numpy.abs(numpy.array([low, high]) - median)
                    axes.errorbar(x, median, yerr=ranges, marker="o", markersize=4, capsize=3, label=", ".join(map(str, label)))
            if numeric and min(values) > 0 and max(values) > 20 * min(values):
                axes.set_xscale("log")
            axes.set(xlabel=key, ylabel=title)
            axes.legend(fontsize="small")
            files += _save(axes, out / f"{name}_by_{key.rsplit('.', 1)[-1]}")
            matplotlib.pyplot.close(axes.figure)
    return files


def figures(results, out, drape: str = "drape") -> list[pathlib.Path]:
    """Writes the figures of a run or a sweep to a folder, which is made, and returns the files. Raises RuntimeError for a
    folder without results."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "drape"})  # texts stay texts; equal runs give equal files
    folder, out = pathlib.Path(results), pathlib.Path(out)
    rows = [row for row in json.loads(_core._table(folder)) if row.get("method")]
    if not rows:
        raise RuntimeError(f"{folder}: no run has written results yet")
    out.mkdir(parents=True, exist_ok=True)
    _write_csv(out / "table.csv", rows)
    (out / "table.tex").write_text(latex_table(rows), encoding="utf-8")
    files = [out / "table.csv", out / "table.tex"]
    return files + (_run_figures(folder, out, drape) if (folder / "results.json").exists() else _sweep_figures(rows, out))


def main() -> int:
    parser = argparse.ArgumentParser(prog="drape figures", description=__doc__)
    parser.add_argument("results", help="results folder of a run, or a sweep's")
    parser.add_argument("-o", "--out", required=True, help="folder of the figures")
    arguments = parser.parse_args()
    try:
        for file in figures(arguments.results, arguments.out, os.environ.get("DRAPE_COMMAND", "drape")):
            print(file)
    except (RuntimeError, OSError, subprocess.CalledProcessError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
