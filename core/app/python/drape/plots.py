"""Plots by matplotlib, in the report's colours (core/app/view/assets/page.css)."""

from __future__ import annotations

import numpy

METHOD_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0518c", "#7a6a00")
COSTS = {"seconds": "time [s]", "iterations": "Newton iterations", "flops": "floating-point operations"}


def _axes(axes):
    import matplotlib.pyplot

    return matplotlib.pyplot.subplots()[1] if axes is None else axes


def _colour(result, method: str) -> str:
    return METHOD_COLOURS[list(result.methods).index(method) % len(METHOD_COLOURS)]


def _rows(table, **wanted):
    chosen = numpy.ones(table.row_count, dtype=bool)
    for column, value in wanted.items():
        chosen &= numpy.asarray(table[column]) == value
    return chosen


def plot_errors(result, measure: str, target: str, cost: str, axes=None):
    """See Result.plot_errors."""
    table = result.errors
    columns = [name for name in table if name.startswith(target + ".")]
    if not columns:
        targets = sorted({name.split(".")[0] for name in table if "." in name})
        raise ValueError(f"the run has no errors against \"{target}\"; "
                         + (f"take target={' or '.join(map(repr, targets))}" if targets else "it recorded no snapshots"))
    column = f"{target}.{measure}" if measure else columns[0]
    if column not in table or cost not in COSTS:
        raise ValueError(f"choose a measure of {[name.split('.', 1)[1] for name in columns]} and a cost of "
                         f"{list(COSTS)}")
    axes = _axes(axes)
    for method in result.methods:
        rows = _rows(table, method=method)
        axes.plot(table[cost][rows], table[column][rows], "o-", markersize=3, label=method,
                  color=_colour(result, method))
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
            axes.plot(table["seconds"][rows], table["force_residual"][rows], color=_colour(result, method),
                      linewidth=0.7 + 0.6 * level, label=method if level == levels[-1] else None)
    axes.set(xlabel="time [s]", ylabel="force residual [1]", yscale="log")
    axes.legend()
    return axes
