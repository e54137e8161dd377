"""Plots by matplotlib, in the report's colours (viewer/page.css) and with its marks."""

from __future__ import annotations

import math
from typing import Any, Dict

from . import _core

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0518c")
MARKS = "os^D"
LINES = ("-", "--", ":", "-.")
COSTS = {"seconds": "time [s]", "iterations": "Newton iterations", "flops": "floating-point operations"}


# What a page of a journal asks for: small type like its text that stays type, thin lines, no frame, vectors. A style of the
# reader's own counts first, whether from matplotlib's matplotlibrc or by --style.
STYLE = {"font.family": ["STIXGeneral", "DejaVu Sans"], "mathtext.fontset": "stix",
         "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7, "legend.fontsize": 8,
         "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.6, "lines.linewidth": 1.2, "grid.linewidth": 0.4,
         "grid.color": "#d9d9d9", "axes.grid": True, "axes.axisbelow": True, "legend.frameon": False, "figure.dpi": 150, "savefig.dpi": 300,
         "pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "drape", "figure.constrained_layout.use": True}


def use_style(file: str = "", width=None) -> None:
    """Sets what the reader's own style leaves at matplotlib's defaults; width of a figure in mm."""
    import matplotlib
    import matplotlib.style

    if "://" in file:
        raise RuntimeError(f"--style {file}: nothing is downloaded; give a style's name or a file")
    mine: Dict[str, Any] = {**STYLE, "figure.figsize": [(width or 84) / 25.4, 0.72 * (width or 84) / 25.4]}
    default = matplotlib.rcParamsDefault
    matplotlib.rcParams.update({key: value for key, value in mine.items() if matplotlib.rcParams[key] == default[key]})
    if file:
        matplotlib.style.use(file)


def style_of(solvers: dict, method: str) -> dict:
    """Colour and mark are those of the method's solver; lines tell methods of one solver apart. Colours are those of the reader's
    style, if it has its own."""
    import matplotlib

    cycle = matplotlib.rcParams["axes.prop_cycle"]
    own = cycle.by_key().get("color", []) if cycle != matplotlib.rcParamsDefault["axes.prop_cycle"] else []
    styles = {name: _core._solver_style(solver) for name, solver in solvers.items()}
    style = styles[method]
    alike = [name for name in styles if styles[name] == style]
    return {"color": own[style % len(own)] if own else COLOURS[style], "marker": MARKS[style], "linestyle": LINES[alike.index(method) % len(LINES)]}


def _axes(axes):
    import matplotlib.pyplot

    return matplotlib.pyplot.subplots()[1] if axes is None else axes


def _look(result, method: str) -> dict:
    return style_of({name: result[name].solver for name in result.methods}, method)


def error_title(column: str) -> str:
    """What a column of errors.csv is, with its unit."""
    target, measure = column.split("_", 1)
    words = {"rms": "RMS distance", "hausdorff": "Hausdorff distance"}.get(measure, measure.replace("_", " "))
    return words + (" from its own end" if target == "own" else " from the reference") + (" [diagonal]" if words.endswith("distance") else "")


def measures_of(errors, target: str) -> list[str]:
    """The measures in which a run's errors.csv has errors against the target, "own" or "reference"."""
    names = [name for name in errors if name.startswith(target + "_")]
    return [name.removeprefix(target + "_") for name in names if errors[name].notna().any()]


def label_logarithmic(axis) -> None:
    """Gives a logarithmic axis, once all is drawn, at least two labels: powers of ten, of a short axis also numbers between them."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

    low, high = sorted(axis.get_view_interval())
    decades = math.log10(high / low)
    between = (1.0,) if decades >= 3 else (1.0, 3.0) if decades >= 1.5 else (1.0, 2.0, 5.0)
    axis.set_major_locator(LogLocator(subs=between, numticks=12) if decades >= 0.8 else MaxNLocator(4))
    axis.set_minor_locator(NullLocator())
    if decades < 3:
        axis.set_major_formatter("{x:g}")


def plot_errors(result, measure: str = "", target: str = "reference", cost: str = "seconds", axes=None):
    """Error over cost, a line for each method, in the report's colours; returns matplotlib's axes.

    measure: as in errors.csv; by default the first there, rms unless the experiment leaves it out. A method
    whose levels do not build on each other has its finest level alone.
    """
    table = result.errors
    measures = measures_of(table, target)
    if not measures:
        others = [repr(name) for name in ("own", "reference") if measures_of(table, name)]
        raise ValueError(f"the run has no errors against \"{target}\"; "
                         + (f"take target={others[0]}" if others else "it recorded no snapshots"))
    measure = measure or measures[0]
    if measure not in measures or cost not in COSTS:
        raise ValueError(f"choose a measure of {measures} and a cost of {list(COSTS)}")
    axes, column = _axes(axes), f"{target}_{measure}"
    levels = result.levels[result.levels["from_initial_state"].fillna(False).astype(bool)]  # a failed level has none
    first = levels.groupby("method")["level"].max()  # the coarsest that the last state builds on
    for method in result.methods:
        rows = table[(table["method"] == method) & (table["level"] >= first.get(method, 0))]
        axes.plot(rows[cost], rows[column], markersize=4, label=method, **_look(result, method))
    axes.set(xlabel=COSTS[cost], ylabel=error_title(column), xscale="log", yscale="log")
    label_logarithmic(axes.xaxis)
    label_logarithmic(axes.yaxis)
    axes.legend()
    return axes


def plot_convergence(result, axes=None):
    """Force residual over time, a line for each level of each method; returns matplotlib's axes."""
    axes = _axes(axes)
    for method in result.methods:
        table = result.iterations[result.iterations["method"] == method]
        for level, rows in table.groupby("level"):
            axes.plot(rows["seconds"], rows["force_residual"], **{**_look(result, method), "marker": ""},
                      linewidth=0.7 + 0.6 * level, label=method if level == table["level"].max() else None)
    axes.set(xlabel="time [s]", ylabel="force residual [1]", yscale="log")
    label_logarithmic(axes.yaxis)
    axes.legend()
    return axes
