"""The figures of a sweep: dots with ranges, values against parameters, distance against cost, a row of pictures."""

from __future__ import annotations

import json
import math
import pathlib
import tempfile
import textwrap

import numpy
import pandas

from . import _core
from .plots import COSTS, error_title, label_logarithmic, style_of

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


def digits(value: float) -> str:
    """A measured number with three digits, as on the pages."""
    whole = abs(value) >= 100 or float(value).is_integer()
    return f"{value:.2e}" if abs(value) >= 1e5 else f"{value:.0f}" if whole else f"{value:#.3g}"


def _name_in(value: str) -> str:
    """By what a map, as JSON, is told from others: its name, the row of a fabric's table, or its type; empty for all else."""
    try:
        fields = json.loads(value)
    except ValueError:
        return ""
    return next((str(fields[name]) for name in ("name", "row", "type") if name in fields), "") if isinstance(fields, dict) else ""


class Keys:
    """The names of the varied keys, as readers know them, with their units. A map goes by what names it, if nothing else has that name; what is long, by
    its number among the rows', from 1."""

    def __init__(self, units: dict, rows=()):
        self.units = units
        self.called: dict[str, dict[str, str]] = {}
        for key in units:
            values = list(dict.fromkeys(str(row[key]) for row in rows))
            long = [value for value in values if len(value) > 24]
            names = [_name_in(value) or value for value in values]
            self.called[key] = {value: str(long.index(value) + 1) for value in long} | {
                value: name for value, name in zip(values, names) if name != value and names.count(name) == 1}
        self.last = [key.rsplit(".", 1)[-1] for key in units]

    def short(self, key: str) -> str:
        word = key.rsplit(".", 1)[-1]
        return word if self.last.count(word) < 2 else key.replace(".", "_")

    def title(self, key: str) -> str:
        unit = self.units.get(key)
        return self.short(key).replace("_", " ") + (f" [{unit}]" if unit else "")

    def value(self, key: str, value) -> str:
        return self.called[key].get(value) or written(value)

    def text(self, key: str, value) -> str:
        text = self.value(key, value)
        return text if text == value else f"{self.short(key).replace('_', ' ')} {text} {self.units.get(key, '')}".strip()


def _letters(width: float, points: float) -> int:
    """How many letters of a type fit into a line [mm]."""
    return max(8, round(width / points / 0.17))


def _fill(text: str, width: float, points: float = 8) -> str:
    """A name in lines as wide as so much type [mm]; underscores, which files need, are spaces to a reader."""
    return textwrap.fill(text.replace("_", " "), _letters(width, points), break_on_hyphens=False, break_long_words=False)


def _panels(titles: list[str], width, height: float):
    """A figure of panels with one scale, row by row, each with its title and, of several, the letter by which a text
    names it; the panels, and the width of one [mm]."""
    import matplotlib.pyplot

    count = len(titles)
    width = width or (COLUMN if count == 1 else PAGE)
    columns = min(count, max(1, round(width / 58)))
    columns = 2 if columns == 3 and count % 3 and count % 2 == 0 else columns
    rows = -(-count // columns)
    figure, axes = matplotlib.pyplot.subplots(rows, columns, squeeze=False, sharey=True,
                                              figsize=(width * MILLIMETRE, rows * height * MILLIMETRE))
    for spare in axes.flat[count:]:
        spare.remove()
    if 1 < count <= 26:
        titles = [f"({chr(ord('a') + number)}) {title}" for number, title in enumerate(titles)]
    # The largest type in which every title is one line.
    points = next((size for size in (8, 7, 6) if max(map(len, titles)) <= _letters(width / columns, size)), None)
    for one, title in zip(axes.flat, titles):
        one.set_title(_fill(title, width / columns, points or 8), **({"fontsize": points} if points and points < 8 else {}))
    return figure, list(axes.flat[:count]), width / columns


def _name_methods(figure, looks: dict, title: str) -> None:
    """The methods' names in their colours, above the panels, and what the panels' common axis shows."""
    from matplotlib.lines import Line2D

    figure.supylabel(textwrap.fill(title, 26), fontsize="medium", multialignment="center")
    lines = [Line2D([], [], label=name, markersize=4, **look) for name, look in looks.items()]
    figure.legend(handles=lines, loc="upper center", ncol=len(lines), labelcolor="linecolor", handlelength=1.6, handletextpad=0.5, columnspacing=1.4, borderpad=0.1)
    if figure.get_layout_engine() is not None:
        figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 5 * MILLIMETRE / figure.get_figheight()))


def is_error(measure: str) -> bool:
    """Whether a measure tells how far an end is from the reference, which has none itself."""
    return measure == "energy_gap" or measure.startswith("error_")


def measure_figure(summary: pandas.DataFrame, measure: str, title: str, key: str, keys: Keys, styles: dict, width=None, log: bool = False):
    """A measure against a key: medians with their ranges over starts, a panel for each value of the other keys.

    Only numbers have an axis and lines; other values stand in the sweep's order, the methods beside each other, with their
    medians where there is room. A method without a value says why: it is the reference, or no start converged.
    """
    others = [name for name in keys.units if name != key]
    groups = list(summary.groupby(others if len(others) > 1 else others[0], sort=False, dropna=False)) if others else [((), summary)]
    groups = [(where if isinstance(where, tuple) else (where,), group) for where, group in groups]
    values = list(dict.fromkeys(map(_hashable, summary[key])))
    numeric = all(isinstance(value, (int, float)) and not isinstance(value, bool) and not math.isnan(value) for value in values)
    logarithmic = numeric and min(values) > 0 and max(values) > 20 * min(values)
    places = [math.log(value) if logarithmic else float(value) for value in (values if numeric else range(len(values)))]
    gap = min(numpy.diff(sorted(places)), default=1.0)
    methods = list(dict.fromkeys(summary["method"]))
    figure, panels, room = _panels([", ".join(keys.text(name, value) for name, value in zip(others, where)) for where, _ in groups], width, 52)
    span = max(places) - min(places)
    apart = min(0.06 * gap, 2 * span / room) if numeric else 0.7 / len(methods)  # so that ranges do not hide each other
    has_room = not numeric and room * 0.8 / len(values) * apart >= 7
    rows = []
    for axes, (where, group) in zip(panels, groups):
        for m, method in enumerate(methods):
            points = []
            for _, row in group[group["method"] == method].iterrows():
                spread, value = row[measure], _hashable(row[key])
                x = places[values.index(value)] + (m - (len(methods) - 1) / 2) * apart
                x = math.exp(x) if logarithmic else x
                cells = spread if isinstance(spread, dict) else {}
                rows.append({**{name: row[name] for name in [*others, key]}, "method": method, "starts": row["starts"],
                             "reference": row["reference"], **{part: cells.get(part) for part in ("median", "low", "high", "count")}})
                if cells:
                    points.append((x, cells["median"], cells["median"] - cells["low"], cells["high"] - cells["median"]))
                    notes = [digits(cells["median"])] * has_room + [f"n = {cells['count']}"] * (cells["count"] < row["starts"])
                    axes.annotate("\n".join(notes), (x, cells["high"]), (0, 3), textcoords="offset points", ha="center", fontsize=6)
                elif not numeric:
                    none_converged = row["converged"].startswith("0 ")
                    why = "reference" if is_error(measure) and row["reference"] else row["converged"] + " converged" if none_converged else "--"
                    axes.text(x, 0.03, why, transform=axes.get_xaxis_transform(), rotation=90, ha="center", va="bottom",
                              fontsize=6, color=styles[method]["color"])
            if points:
                x, y, below, above = zip(*sorted(points))
                look = styles[method] if numeric else {**styles[method], "linestyle": ""}
                axes.errorbar(x, y, yerr=[below, above], markersize=4, elinewidth=1, capsize=2, **look)
        if numeric:
            axes.set_xscale("log" if logarithmic else "linear")
            if len(values) < 7:
                axes.set_xticks(values, [keys.value(key, value) for value in values])
                axes.minorticks_off()
            elif logarithmic:
                label_logarithmic(axes.xaxis)
            axes.margins(x=0.1)
            axes.set_xlabel(keys.title(key))
        else:
            axes.set_xticks(places, [keys.text(key, value).replace("_", " ") if value is not None else "--" for value in values])
            axes.set_xlim(-0.5, len(values) - 0.5)
            axes.tick_params(axis="x", length=0)
            axes.grid(False, axis="x")
    drawn = [row for row in rows if row["median"] is not None]
    if log:
        panels[0].set_yscale("log")
        label_logarithmic(panels[0].yaxis)
    elif all(row["low"] >= 0 for row in drawn):
        panels[0].set_ylim(0, None if any(row["high"] for row in drawn) else 1)
    absent = set(methods) - {row["method"] for row in drawn}
    is_reference = {row["method"] for row in rows if row["reference"] and is_error(measure)}
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
    costs = numpy.array([end]) if begin == end else numpy.linspace(begin, end, 60) if cost == "iterations" else numpy.geomspace(begin, end, 60)
    values = numpy.array([[curve[curve[cost] <= at * (1 + 1e-12)][column].iloc[-1] for at in costs] for curve in curves])
    return pandas.DataFrame({cost: costs, "median": numpy.median(values, axis=0), "low": values.min(axis=0), "high": values.max(axis=0),
                             "count": len(curves)})


def error_columns(runs: dict) -> list[str]:
    """The column of errors.csv that is drawn for each target, the reference first, as far as one of the runs has it."""
    known = {column for results in runs.values() for result in results for column in result.errors if result.errors[column].notna().any()}
    columns = ([f"{target}_{name}" for name in ("rms", "hausdorff", "energy_gap") if f"{target}_{name}" in known] for target in ("reference", "own"))
    return [own[0] for own in columns if own]


def distance_figure(runs: dict, column: str, cost: str, styles: dict, references: dict, drawn: dict, width=None, busy: bool = False):
    """Distance against cost: a panel for each variation, a line for each method with a band over its starts, from where the first
    leaves the start, with the methods that were the reference and, in the corner below the lines, a picture.

    runs: the results of each variation's starts, by its title; column: of `error_columns`; references: in words, likewise; drawn: of
    `draw_states`.
    """
    rows = []
    figure, panels, room = _panels(list(runs), width, 50)
    for axes, (title, results) in zip(panels, runs.items()):
        begin = math.inf
        for m, (method, look) in enumerate(styles.items()):
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
            axes.plot(curve[cost], curve["median"], **look, markersize=3.5, markevery=[*range(4 * m + 2, len(curve) - 2, 12), len(curve) - 1])
            axes.fill_between(curve[cost], curve["low"], curve["high"], color=look["color"], alpha=0.18, linewidth=0)
            rows.append(curve.assign(variation=title, method=method))
            begin = min(begin, curve[cost][curve["low"] > 0.9 * curve["high"].iloc[0]].max())
        axes.set(yscale="log", xlabel=COSTS[cost] + (", on a busy machine" if busy and cost == "seconds" else ""))
        if cost != "iterations":
            axes.set(xscale="log", xlim=(begin / 1.2 if begin < math.inf else None, None))
            label_logarithmic(axes.xaxis)
        if column.startswith("reference") and references[title]:
            words = _fill("reference: " + references[title], 0.75 * room, 6)
            axes.set_title(axes.get_title(), fontsize=axes.title.get_fontsize(), pad=4 + 7 * (1 + words.count("\n")))
            axes.text(0.5, 1.02, words, transform=axes.transAxes, fontsize=6, ha="center", va="bottom")
        image, _ = next(iter(drawn[title].values()), (None, ""))
        if image is not None:
            axes.inset_axes([0.01, 0.02, 0.3, 0.42], anchor="SW", xticks=[], yticks=[], frame_on=False).imshow(image)
    label_logarithmic(panels[0].yaxis)  # which all share
    _name_methods(figure, styles, error_title(column))
    return figure, pandas.concat(rows) if rows else pandas.DataFrame()


def draw_states(runs: dict, methods, width=None) -> dict:
    """Of each variation's first start, with the variation's camera, the preview and the end of each method, and what they have
    cost: {title: {(method, "preview" or "end"): (picture, words)}}."""
    import matplotlib.pyplot

    pixels = max(120, min(480, round((width or PAGE) * MILLIMETRE * 300 / (2 * len(methods)))))  # what 300 dpi show
    drawn: dict = {title: {} for title in runs}
    with tempfile.TemporaryDirectory(prefix="drape_pictures_") as folder:
        file = pathlib.Path(folder, "state.png")
        for title, results in runs.items():
            for method in (name for name in methods if name in results[0].methods):
                levels = [level for level in results[0][method].levels if vars(level).get("mesh")]
                cost = 0.0
                for level in levels:
                    cost = (0 if vars(level).get("from_initial_state") else cost) + (vars(level).get("cpu_seconds") or math.nan)
                    if level in (levels[0], levels[-1]):
                        _core._draw(results[0].folder, file, method, level=level.level, width=pixels, edges=False)
                        words = f"{level.vertices / 1000:.2g}K vertices" + (f", {cost:.2g} CPU s" if cost > 0 else "")
                        drawn[title][method, "end" if level is levels[-1] else "preview"] = matplotlib.pyplot.imread(file), words
    return drawn


def pictures_figure(drawn: dict, styles: dict, width=None):
    """The pictures of `draw_states`, a row for each variation; in a narrow figure one for previews and one for ends. None without any."""
    import matplotlib.pyplot

    width = width or PAGE
    states = list(dict.fromkeys(state for pictures in drawn.values() for _, state in pictures))
    wide = width >= 25 * len(styles) * len(states)
    cells = {((title, "" if wide else state), (method, state if wide else "")): picture
             for title, pictures in drawn.items() for (method, state), picture in pictures.items()}
    if not cells:
        return None
    rows, columns = (list(dict.fromkeys(where[side] for where in cells)) for side in (0, 1))
    height = width / len(columns) * 7 / 9 + 4
    figure, axes = matplotlib.pyplot.subplots(len(rows), len(columns), squeeze=False,
                                              figsize=(width * MILLIMETRE, (len(rows) * height + 4) * MILLIMETRE))
    if figure.get_layout_engine() is not None:
        figure.get_layout_engine().set(w_pad=0.01, h_pad=0.01)
    for one, where in zip(axes.flat, ((row, column) for row in rows for column in columns)):
        one.set(xticks=[], yticks=[], frame_on=False)
        if where in cells:
            one.imshow(cells[where][0])
            one.set_xlabel(cells[where][1], fontsize=6, labelpad=1)
    for one, (method, state) in zip(axes[0], columns):
        one.set_title(", ".join(filter(None, (method, state))), color=styles[method]["color"])
    for one, (title, state) in zip(axes[:, 0], rows):
        one.set_ylabel(_fill(", ".join(filter(None, (title, state))), height, 7), fontsize="small")
    return figure, pandas.DataFrame([{"variation": title, "method": method, "state": state, "caption": words}
                                     for title, pictures in drawn.items() for (method, state), (_, words) in pictures.items()])


def styles_of(rows: pandas.DataFrame) -> dict:
    """The look of each method by its solver, as on every page, in the sweep's order."""
    solvers = rows.drop_duplicates("method").set_index("method")["solver"].to_dict()
    return {name: style_of(solvers, name) for name in solvers}
