"""Plots of the records, as SVG that fits light and dark pages: PLOTS, by the name of the picture in docs/pictures, give its text.

Colours and marks are those of the report (viewer/page.css); pcs_loop, whose solver is that of pcs, has its mark in a lighter
blue. A function of a record that is not stored raises FileNotFoundError."""

import math
from html import escape

from figures import best_in_table1, named_ablations, plain_name
from records import figure, median

COLOURS = {"pcs": "#0072b2", "pcs_loop": "#56a0d8", "cascadic": "#d55e00", "newton": "#009e73"}
CIRCLE, SQUARE, TRIANGLE = "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0z", "M-4-4h8v8h-8z", "M0-5L5 4H-5z"
MARKS = {"pcs": CIRCLE, "pcs_loop": CIRCLE, "cascadic": SQUARE, "newton": TRIANGLE}
STYLE = """text { font: 13px sans-serif; fill: #1b2027 } line { stroke: #c9ced6 }
@media (prefers-color-scheme: dark) { text { fill: #e6e9ee } line { stroke: #4a515c } }"""
WIDTH, LABELS, ROW, TOP = 860, 256, 24, 52


def rounded_up(value):
    """To one digit that is 1, 2, 4, 6, 8 or 10 times a power of ten."""
    power = 10 ** math.floor(math.log10(value))
    return next(digit for digit in (1, 2, 4, 6, 8, 10) if digit * power >= value * (1 - 1e-9)) * power


def dots(rows, panels, most=None):
    """A row a label, with a mark for each method in each panel. `rows`: {label: {method: [a value a panel]}}; panels: what they show;
    most: the end of every axis, by default one for each panel."""
    methods = [m for m in COLOURS if any(m in of_row for of_row in rows.values())]
    wide = (WIDTH - LABELS) / len(panels)
    height = TOP + ROW * len(rows) + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}">', f"<style>{STYLE}</style>"]
    for k, method in enumerate(methods):
        out.append(f'<path d="{MARKS[method]}" fill="{COLOURS[method]}" transform="translate({LABELS + 10 + 110 * k} 14)"/>'
                   f'<text x="{LABELS + 20 + 110 * k}" y="18">{method}</text>')
    for row, label in enumerate(rows):
        y = TOP + ROW * (row + 0.5)
        out.append(f'<text x="{LABELS - 12}" y="{y + 4:g}" text-anchor="end">{escape(label)}</text>')
    for p, panel in enumerate(panels):
        left, right = LABELS + p * wide + 10, LABELS + (p + 1) * wide - 24
        end = most or rounded_up(max(values[p] for of_row in rows.values() for values in of_row.values()))
        at = lambda value: left + (right - left) * value / end  # noqa: E731
        out.append(f'<text x="{left:g}" y="42">{escape(panel)}</text>')
        for value in (0, end / 2, end):
            out.append(f'<line x1="{at(value):.1f}" x2="{at(value):.1f}" y1="{TOP}" y2="{height - 26}"/>'
                       f'<text x="{at(value):.1f}" y="{height - 10}" text-anchor="middle">{figure(value, 2)}</text>')
        for row, of_row in enumerate(rows.values()):
            y = TOP + ROW * (row + 0.5)
            out.append(f'<line x1="{left:g}" x2="{right:g}" y1="{y:g}" y2="{y:g}"/>')
            for method in reversed([m for m in methods if m in of_row]):
                out.append(f'<path d="{MARKS[method]}" fill="{COLOURS[method]}" transform="translate({at(of_row[method][p]):.1f} {y:g})"/>')
    return "\n".join(out) + "\n</svg>\n"


def ablations():
    named, direct = named_ablations()
    rows = {}
    for (variant, method), runs in named.items():
        flops, distance = median([r["tflop"] for r in runs]) / direct, median([r["preview"]["distance_rms"] for r in runs])
        rows.setdefault(plain_name(variant), {})[method] = [flops, distance]
    return dots(rows, ["total flops, relative to direct", "preview: RMS distance [diagonals]"])


def table1():
    rows = {scene: {method: [counts[method] / rows_of for rows_of, counts in best] for method in best[0][1]}
            for scene, best in best_in_table1().items()}
    return dots(rows, ["best by curvature", "best by distance, silhouette", "best by energy"], most=1)


PLOTS = {"ablations": ablations, "table1": table1}
