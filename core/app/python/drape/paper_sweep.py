"""The figures of a sweep: dots with ranges, values against parameters, distance against cost, a row of pictures."""

from __future__ import annotations

import math
import pathlib
import tempfile
import textwrap

import numpy
import pandas

from . import _core
from .plots import COSTS, style_of

MILLIMETRE = 1 / 25.4  # [inch]
COLUMN, PAGE = 84, 174  # widths of a column and of a page [mm]


def written(value) -> str:
    """A key's value with the digits that it was written with: 8e7, 0.1, loop."""
    if value is None or isinstance(value, float) and math.isnan(value):
        return "--"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    size = abs(value)
    if size == 0 or 1e-3 <= size < 1e5:
        return f"{value:g}"
    digits, power = f"{value:e}".split("e")
    return f"{float(digits):g}e{int(power)}"


class Keys:
    """The names of the varied keys, as readers know them, with their units. A value that is a map or a list goes by its number among
    the rows', from 1, as in the names of runs."""

    def __init__(self, units: dict, rows=()):
        self.units = units
        self.long = {key: [value for value in dict.fromkeys(str(row[key]) for row in rows) if len(value) > 24] for key in units}
        self.last = [key.rsplit(".", 1)[-1] for key in units]

    def short(self, key: str) -> str:
        word = key.rsplit(".", 1)[-1]
        return word if self.last.count(word) < 2 else key.replace(".", "_")

    def title(self, key: str) -> str:
        unit = self.units.get(key)
        return self.short(key).replace("_", " ") + (f" [{unit}]" if unit else "")

    def value(self, key: str, value) -> str:
        return str(self.long[key].index(value) + 1) if value in self.long.get(key, ()) else written(value)

    def text(self, key: str, value) -> str:
        text = self.value(key, value)
        return text if text == value else f"{self.short(key).replace('_', ' ')} {text} {self.units.get(key, '')}".strip()


def _panels(count: int, width, height: float):
    """A figure of so many panels with one scale, row by row, and its axes."""
    import matplotlib.pyplot

    width = width or (COLUMN if count == 1 else PAGE)
    columns = min(count, max(1, round(width / 58)))
    columns = 2 if columns == 3 and count % 3 and count % 2 == 0 else columns
    rows = -(-count // columns)
    figure, axes = matplotlib.pyplot.subplots(rows, columns, squeeze=False, sharey=True,
                                              figsize=(width * MILLIMETRE, rows * height * MILLIMETRE))
    for spare in axes.flat[count:]:
        spare.remove()
    return figure, list(axes.flat[:count])


def _name_methods(figure, looks: dict, title: str) -> None:
    """The methods' names in their colours, above the panels, and what the panels' common axis shows."""
    from matplotlib.lines import Line2D

    figure.supylabel(textwrap.fill(title, 26), fontsize="medium", multialignment="center")
    lines = [Line2D([], [], label=name, markersize=4, **look) for name, look in looks.items()]
    figure.legend(handles=lines, loc="upper center", ncol=len(lines), labelcolor="linecolor", handlelength=1.6, columnspacing=1.4, borderpad=0.1)
    if figure.get_layout_engine() is not None:
        figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 5 * MILLIMETRE / figure.get_figheight()))


def _lines(text: str) -> str:
    """A title with a line for each of its parts, where one line would be long."""
    return text.replace(", ", ",\n") if len(text) > 28 else text


def measure_figure(summary: pandas.DataFrame, measure: str, title: str, key: str, keys: Keys, styles: dict, width=None, log: bool = False):
    """A measure against a key: medians with their ranges over starts, a panel for each value of the other keys.

    Only numbers have an axis and lines; other values stand in the sweep's order, the methods beside each other. A method
    without a value says why: it is the reference, or no start converged.
    """
    others = [name for name in keys.units if name != key]
    groups = list(summary.groupby(others if len(others) > 1 else others[0], sort=False, dropna=False)) if others else [((), summary)]
    values = list(dict.fromkeys(map(_hashable, summary[key])))
    numeric = all(isinstance(value, (int, float)) and not isinstance(value, bool) and not math.isnan(value) for value in values)
    methods = list(dict.fromkeys(summary["method"]))
    figure, panels = _panels(len(groups), width, 52)
    rows = []
    for axes, (where, group) in zip(panels, groups):
        where = where if isinstance(where, tuple) else (where,)
        for m, method in enumerate(methods):
            points = []
            for _, row in group[group["method"] == method].iterrows():
                spread, value = row[measure], _hashable(row[key])
                x = value if numeric else values.index(value) + (m - (len(methods) - 1) / 2) * 0.7 / len(methods)
                cells = spread if isinstance(spread, dict) else {}
                rows.append({**{name: row[name] for name in [*others, key]}, "method": method, "starts": row["starts"],
                             "reference": row["reference"], **{part: cells.get(part) for part in ("median", "low", "high", "count")}})
                if cells:
                    points.append((x, cells["median"], cells["median"] - cells["low"], cells["high"] - cells["median"]))
                    if cells["count"] < row["starts"]:
                        axes.annotate(f"n = {cells['count']}", (x, cells["high"]), (0, 3), textcoords="offset points", ha="center", fontsize=6)
                elif not numeric:
                    why = "reference" if row["reference"] else row["converged"] + " converged"
                    axes.text(x, 0.03, why, transform=axes.get_xaxis_transform(), rotation=90, ha="center", va="bottom",
                              fontsize=6, color=styles[method]["color"])
            if points:
                x, y, below, above = zip(*sorted(points))
                look = styles[method] if numeric else {**styles[method], "linestyle": ""}
                axes.errorbar(x, y, yerr=[below, above], markersize=4, elinewidth=1, capsize=2, **look)
        if numeric:
            if min(values) > 0 and max(values) > 20 * min(values):
                axes.set_xscale("log")
            axes.set_xlabel(keys.title(key))
        else:
            axes.set_xticks(range(len(values)), [keys.text(key, value) if value is not None else "--" for value in values])
            axes.set_xlim(-0.5, len(values) - 0.5)
            axes.tick_params(axis="x", length=0)
        if others:
            axes.set_title(_lines(", ".join(keys.text(name, value) for name, value in zip(others, where))))
    if log:
        panels[0].set_yscale("log")
    elif all(row["low"] is None or row["low"] >= 0 for row in rows):
        panels[0].set_ylim(bottom=0)
    absent = {method for method in methods if all(row["median"] is None for row in rows if row["method"] == method)}
    is_reference = {row["method"] for row in rows if row["reference"]}
    why = {name: ": the reference" if name in is_reference else ": no value" for name in absent}
    unjoined = {} if numeric else {"linestyle": ""}
    _name_methods(figure, {name + why.get(name, ""): {**styles[name], **unjoined} for name in methods}, title)
    return figure, pandas.DataFrame(rows)


def _hashable(value):
    if isinstance(value, (list, dict)):
        return str(value)
    return None if isinstance(value, float) and math.isnan(value) else value.item() if isinstance(value, numpy.generic) else value


def _median_curve(curves, cost: str, column: str) -> pandas.DataFrame:
    """Median and range of step functions of error over cost, from where all have a state to the last one's end."""
    curves = [curve[(curve[cost] > 0) & (curve[column] > 0)] for curve in curves]
    curves = [curve for curve in curves if len(curve)]
    if not curves:
        return pandas.DataFrame(columns=[cost, "median", "low", "high", "count"])
    begin, end = max(curve[cost].iloc[0] for curve in curves), max(curve[cost].iloc[-1] for curve in curves)
    costs = numpy.geomspace(begin, end, 40) if begin < end else numpy.array([end])
    values = numpy.array([[curve[curve[cost] <= at * (1 + 1e-12)][column].iloc[-1] for at in costs] for curve in curves])
    return pandas.DataFrame({cost: costs, "median": numpy.median(values, axis=0), "low": values.min(axis=0), "high": values.max(axis=0),
                             "count": len(curves)})


def distance_figure(runs: dict, cost: str, methods, styles: dict, width=None, busy: bool = False):
    """Distance against cost: a panel for each variation, a line for each method with a band over its starts.

    runs: the results of each variation's starts, by its title. None without any recorded error.
    """
    columns = [f"{target}_{name}" for target in ("reference", "own") for name in ("rms", "hausdorff", "energy_gap")]
    known = [column for column in columns if any(column in r.errors and r.errors[column].notna().any() for all_ in runs.values() for r in all_)]
    if not known:
        return None
    column, rows = known[0], []
    figure, panels = _panels(len(runs), width, 50)
    for axes, (title, results) in zip(panels, runs.items()):
        for method in methods:
            curves = []
            for result in results:
                if method not in result.methods or column not in result.errors:
                    continue
                levels = result.levels[(result.levels["method"] == method) & result.levels["from_initial_state"].fillna(False).astype(bool)]
                first = levels["level"].max() if len(levels) else 0
                curves.append(result.errors[(result.errors["method"] == method) & (result.errors["level"] >= first)])
            curve = _median_curve(curves, cost, column)
            if len(curve) == 0:
                continue
            look = {**styles[method], "marker": ""}
            axes.plot(curve[cost], curve["median"], **look)
            axes.fill_between(curve[cost], curve["low"], curve["high"], color=look["color"], alpha=0.18, linewidth=0)
            rows.append(curve.assign(variation=title, method=method))
        axes.set(xscale="log", yscale="log", title=_lines(title), xlabel=COSTS[cost] + (", on a busy machine" if busy and cost == "seconds" else ""))
    words = {"rms": "RMS distance", "hausdorff": "Hausdorff distance", "energy_gap": "energy gap"}[column.split("_", 1)[1]]
    unit = "" if column.endswith("energy_gap") else " [diagonal]"
    _name_methods(figure, {name: {**styles[name], "marker": ""} for name in methods},
                  words + (" from the reference" if column.startswith("reference") else " from its own end") + unit)
    return figure, pandas.concat(rows) if rows else pandas.DataFrame()


def pictures_figure(runs: dict, methods, width=None):
    """The preview and the end of each method in the first start of each variation, with the variation's camera."""
    import matplotlib.pyplot

    width = width or PAGE
    pixels = max(120, min(480, round(width * MILLIMETRE * 300 / (2 * len(methods)))))  # what 300 dpi show
    shown, titles = [], []
    with tempfile.TemporaryDirectory(prefix="drape_pictures_") as folder:
        for title, results in runs.items():
            drawn: list[tuple[str, numpy.ndarray]] = []
            for method in methods:
                levels = [entry.level for entry in results[0][method].levels if vars(entry).get("mesh")] if method in results[0].methods else []
                for level in dict.fromkeys([levels[0], levels[-1]] if levels else []):
                    file = pathlib.Path(folder, f"{len(drawn)}.png")
                    _core._draw(results[0].folder, file, method, level=level, width=pixels, edges=False)
                    drawn.append((method + (", preview" if level != levels[-1] else ", end"), matplotlib.pyplot.imread(file)))
            shown.append(dict(drawn))
            titles.append(title)
    names = list(dict.fromkeys(name for images in shown for name in images))
    if not names:
        return None
    height = width / len(names) * 7 / 9
    figure, axes = matplotlib.pyplot.subplots(len(shown), len(names), squeeze=False, figsize=(width * MILLIMETRE, (len(shown) * height + 5) * MILLIMETRE))
    if figure.get_layout_engine() is not None:
        figure.get_layout_engine().set(w_pad=0.01, h_pad=0.01)
    for row, (title, images) in enumerate(zip(titles, shown)):
        for column, name in enumerate(names):
            one = axes[row][column]
            one.set(xticks=[], yticks=[], frame_on=False)
            if name in images:
                one.imshow(images[name])
            if row == 0:
                one.set_title(name)
            if column == 0:
                one.set_ylabel(textwrap.fill(title, 17), fontsize="small")
    return figure, pandas.DataFrame({"variation": titles, "folder": [results[0].folder for results in runs.values()]})


def styles_of(rows: pandas.DataFrame) -> dict:
    """The look of each method by its solver, as on every page."""
    solvers = rows.drop_duplicates("method").set_index("method")["solver"].to_dict()
    return {name: style_of(solvers, name) for name in solvers}
