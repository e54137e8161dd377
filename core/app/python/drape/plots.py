"""Plots by matplotlib, in the report's colours (viewer/page.css) and with its marks."""

from __future__ import annotations

from . import _core

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0518c")
MARKS = "os^D"
LINES = ("-", "--", ":", "-.")
COSTS = {"seconds": "time [s]", "iterations": "Newton iterations", "flops": "floating-point operations"}


def _axes(axes):
    import matplotlib.pyplot

    return matplotlib.pyplot.subplots()[1] if axes is None else axes


def _look(result, method: str) -> dict:
    """Colour and mark are those of the method's solver; lines tell methods of one solver apart."""
    styles = {name: _core._solver_style(result[name].solver) for name in result.methods}
    style = styles[method]
    alike = [name for name in result.methods if styles[name] == style]
    return {"color": COLOURS[style], "marker": MARKS[style], "linestyle": LINES[alike.index(method) % len(LINES)]}


def measures_of(errors, target: str) -> list[str]:
    """The measures in which a run's errors.csv has errors against the target, "own" or "reference"."""
    names = [name for name in errors if name.startswith(target + "_")]
    return [name.removeprefix(target + "_") for name in names if errors[name].notna().any()]


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
    axes.set(xlabel=COSTS[cost], ylabel=column, xscale="log", yscale="log")
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
    axes.legend()
    return axes
