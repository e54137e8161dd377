"""Plots by matplotlib, in the report's colours (viewer/page.css) and with its marks."""

from __future__ import annotations

import numpy

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0518c")
MARKS = "os^D"
LINES = ("-", "--", ":", "-.")
COSTS = {"seconds": "time [s]", "iterations": "Newton iterations", "flops": "floating-point operations"}


def _axes(axes):
    import matplotlib.pyplot

    return matplotlib.pyplot.subplots()[1] if axes is None else axes


def _look(result, method: str) -> dict:
    """Colour and mark are those of the method's solver; lines tell methods of one solver apart."""
    style = result[method]._style
    alike = [name for name in result.methods if result[name]._style == style]
    return {"color": COLOURS[style], "marker": MARKS[style], "linestyle": LINES[alike.index(method) % len(LINES)]}


def _rows(table, **wanted):
    chosen = numpy.ones(table.row_count, dtype=bool)
    for column, value in wanted.items():
        chosen &= numpy.asarray(table[column]) == value
    return chosen


def _first_level(result, method: str) -> int:
    """The coarsest level that the method's last state builds on: of a direct method the finest."""
    table = result.levels
    begun = _rows(table, method=method, from_initial_state=True)
    return max(table["level"][begun], default=0)


def plot_errors(result, measure: str, target: str, cost: str, axes=None):
    """See Result.plot_errors."""
    table = result.errors
    measures = {t: [name.removeprefix(t + "_") for name in table if name.startswith(t + "_")
                    and not numpy.all(numpy.isnan(table[name]))] for t in ("own", "reference")}
    if not measures.get(target):
        targets = [repr(name) for name, found in measures.items() if found]
        raise ValueError(f"the run has no errors against \"{target}\"; "
                         + (f"take target={' or '.join(targets)}" if targets else "it recorded no snapshots"))
    measure = measure or measures[target][0]
    if measure not in measures[target] or cost not in COSTS:
        raise ValueError(f"choose a measure of {measures[target]} and a cost of {list(COSTS)}")
    axes, column = _axes(axes), f"{target}_{measure}"
    for method in result.methods:
        rows = _rows(table, method=method) & (table["level"] >= _first_level(result, method))
        axes.plot(table[cost][rows], table[column][rows], markersize=4, label=method, **_look(result, method))
    axes.set(xlabel=COSTS[cost], ylabel=column, xscale="log", yscale="log")
    axes.legend()
    return axes


def plot_convergence(result, axes=None):
    """See Result.plot_convergence."""
    table = result.iterations
    axes = _axes(axes)
    for method in result.methods:
        levels = sorted(set(table["level"][_rows(table, method=method)]))
        for level in levels:
            rows = _rows(table, method=method, level=level)
            axes.plot(table["seconds"][rows], table["force_residual"][rows],
                      **{**_look(result, method), "marker": ""}, linewidth=0.7 + 0.6 * level,
                      label=method if level == levels[-1] else None)
    axes.set(xlabel="time [s]", ylabel="force residual [1]", yscale="log")
    axes.legend()
    return axes
