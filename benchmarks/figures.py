"""What pages say of the records: BLOCKS, by name, give the lines of a table, VALUES the figures within sentences.

A function of a record that is not stored raises FileNotFoundError; fill_figures then says so in its place."""

import csv
import itertools
import math
import re
import statistics
from operator import itemgetter

from records import CONVERGED, RESULTS, WITHOUT_CONTACT, conditions, figure, median, read, seconds_text, stamps, usual_conditions, with_range

TFLOP = itemgetter("tflop")
PREVIEW_DISTANCE = lambda r: r["preview"]["distance_rms"]  # noqa: E731
STUDIES_OF_SCENES = {"previews": "six scenes, three levels", "four_levels": "six scenes, four levels", "garments": "garments"}
COSTS = {"time to the end": itemgetter("seconds"), "flops to the end": TFLOP, "time to the preview": itemgetter("seconds_of_preview"),
         "distance of the preview from its end": PREVIEW_DISTANCE, "distance of level 1": lambda r: r["level_1"]["distance_rms"],
         "energy of the preview above its end": lambda r: r["preview"]["energy_above_end"]}
METHODS = ["pcs", "cascadic", "newton"]
TOLERANCES_AND_STEPS = ["tolerance_1e-2", "tolerance_1e-4", "step_growth_1", "step_growth_3", "step_size_0.01_s", "step_size_1_s"]  # of ablations
TWO_DRAPES = ["hanging", "draped"]  # the scenes of two_drapes.py
MEASURED = ["cotton-broad", "wool-tropical", "polyester-tropical", "polyester-faille"]  # their drape coefficients
STRETCHED = ["11oz-black-denim", "tango-red-jet-set", "gray-interlock"]  # their tension
FABRICS = [*MEASURED, *(f"{fabric} elastic" for fabric in MEASURED), *STRETCHED, *(f"{fabric} default tension" for fabric in STRETCHED), "cotton"]


def table(head, rows, right):
    """A Markdown table; `right` has an r for each column of numbers."""
    rule = "|".join("---:" if k < len(right) and right[k] == "r" else "---" for k in range(len(head)))
    return ["| " + " | ".join(head) + " |", f"|{rule}|"] + ["| " + " | ".join(row) + " |" for row in rows]


def runs(study, method, scene=None, variant=None):
    found = [r for r in read(f"{study}.json") if r["method"] == method and scene in (None, r["scene"])
             and variant in (None, r["variant"])]
    if not found:
        raise KeyError(f"{study}, {method}")
    return found


def finished(study, method, scene=None, variant=None):
    """Runs of which all came to rest: a preview is near to an end that is none."""
    found = runs(study, method, scene, variant)
    if any(r["status"] not in CONVERGED for r in found):
        raise LookupError(f"{study}: {method} has not come to rest from every start")
    return found


def of(records, key):
    return median([r[key] for r in records])


def grouped(records, *keys):
    """Lists of records by their values of these keys."""
    found = {}
    for r in records:
        found.setdefault(itemgetter(*keys)(r), []).append(r)
    return found


def start_by_start(study, value, other="cascadic"):
    """PCS's value over another method's, scene by scene and start by start."""
    base = {(r["scene"], r["seed"]): value(r) for r in finished(study, other)}
    return [value(r) / base[r["scene"], r["seed"]] for r in finished(study, "pcs", variant="default")]


def starts_above(study, value):
    """Number of starts from which PCS has more than the cascadic method."""
    ratios = start_by_start(study, value)
    return f"{sum(ratio > 1 for ratio in ratios)} of {len(ratios)}"


def lowest_to_highest(values):
    """The range of a figure, for a sentence; one figure where the two read alike."""
    lowest, highest = figure(min(values), 2), figure(max(values), 2)
    return lowest if lowest == highest else f"{lowest} to {highest}"


def iterations(records):
    return [median(level) for level in zip(*(r["iterations"] for r in records))]


def plain_name(variation):
    """A variation's name as pages have it; records made before `psd_blend: adaptive` had its name call it "least"."""
    return variation.replace("_", " ").replace("as it is", "defaults").replace("least", "adaptive")


def distance_of_previews(records):
    return median([r["preview"]["distance_rms"] for r in records])


def preview(records, measure):
    return figure(median([r["preview"][measure] for r in records]))


def sphere(columns):
    """A row a method of the sphere to 98K vertices."""
    cells = {
        "iterations": lambda r: ", ".join(figure(n) for n in iterations(r)),
        "preview [s]": lambda r: seconds_text([x["seconds_of_preview"] for x in r]),
        "total [s]": lambda r: seconds_text([x["seconds"] for x in r]),
        "total flops, relative to direct": lambda r: figure(of(r, "tflop") / of(finished("sphere", "newton"), "tflop"), 2),
        "final energy [J]": lambda r: figure(of(r, "energy"), 6),
        "preview: RMS distance from the final state [diagonals]": lambda r: with_range([x["preview"]["distance_rms"] for x in r], lambda v: figure(v, 2)),
        "silhouette overlap": lambda r: preview(r, "silhouette_overlap"),
        "preview: energy above the final state [J]": lambda r: preview(r, "energy_above_end"),
        "level 1: RMS distance": lambda r: with_range([x["level_1"]["distance_rms"] for x in r], lambda v: figure(v, 2))}
    rows = [[m] + [cells[c](finished("sphere", m)) for c in columns] for m in METHODS]
    return table(["method"] + ["Newton iterations by level" if c == "iterations" else c for c in columns], rows,
                 "ll" + "r" * (len(columns) - 1))


def rows_of(record):
    """The rows of a record's first Markdown table, by the names of its columns."""
    from_table = itertools.dropwhile(lambda line: not line.startswith("|"), (RESULTS / record).read_text().splitlines())
    cells = [[c.strip() for c in line.strip("|").split("|")] for line in itertools.takewhile(lambda line: line.startswith("|"), from_table)]
    return [dict(zip(cells[0], row)) for row in cells[2:]]


def scene_row(name):
    """Of the study that runs each scene to its finest level."""
    return next(r for r in rows_of("scenes.md") if r["run"] == name)


def seconds_of_scenes(least, most):
    """The range over the scenes whose finest level has so many vertices."""
    seconds = [float(r["seconds"]) for r in rows_of("scenes.md") if least <= int(r["vertices"]) <= most]
    return f"{min(seconds):.0f} to {max(seconds):.0f}"


def minutes_of(name):
    return figure(float(scene_row(name)["seconds"]) / 60, 2)


def scenes(study, columns):
    """PCS, the cascadic method and the direct solve, a row a scene: the columns of the study's summary that are asked for."""
    rows = [[r["scene"]] + [r[c] for c in columns] for r in rows_of(f"{study}.md")]
    right = "l" + "".join("r" if c in ("preview's flops, relative to cascadic", TOP[-1]) else "l" for c in columns)
    return table(["scene"] + columns, rows, right)


def fine_meshes():
    """A row a scene, on a random mesh: coarser levels under it beside a direct solve of it and regular levels on its outline."""
    rows = []
    for scene in dict.fromkeys(r["scene"] for r in read("fine_meshes.json")):
        coarsened, cascadic, regular, direct = (finished("fine_meshes", method, scene, variant) for method, variant in (
            ("pcs", "coarsened"), ("cascadic", "coarsened"), ("pcs", "regular"), ("newton", "direct")))
        distances = [preview(records, "distance_rms") for records in (coarsened, cascadic, regular)]
        finest = [figure(iterations(records)[-1]) for records in (coarsened, regular, direct)]
        times = [figure(of(records, "cpu_seconds") / of(direct, "cpu_seconds"), 2) for records in (coarsened, cascadic, regular)]
        rows.append([scene, *(" / ".join(cells) for cells in (distances, finest, times))])
    return table(["scene", "preview, RMS: pcs / cascadic / regular pcs", "finest level, iterations: pcs / regular pcs / direct",
                  "CPU time, relative to direct: pcs / cascadic / regular pcs"], rows, "llll")


def best_in_table1():
    """For each scene, of the rows of curvature, of distance and of energy: how many, and on how many each method is best."""
    text = (RESULTS / "table1.md").read_text()
    found = {}
    for scene in read("table1.json"):
        section = text.split(f"\n## {scene}", 1)[1].split("\n## ", 1)[0]
        found[scene] = [(int(rows_of), {method: int(count) for method, count in re.findall(r"(\w+) (\d+)", counts)})
                        for rows_of, counts in re.findall(r"Best on the (\d+) rows of [^:]*:([^.]*)\.", section)]
    return found


def table1():
    """A row a scene of the supplement's Table 1: on how many rows each method is best, iterations."""
    rows, best = [], best_in_table1()
    for scene, entry in read("table1.json").items():
        methods = entry["methods"]
        first = next(iter(methods.values()))
        rows.append([scene, str(first["vertices_by_level"][-1]),
                     *(" / ".join(str(counts[m]) for m in methods) + f" of {rows_of}" for rows_of, counts in best[scene]),
                     " / ".join(str(r["iterations_by_level"][-1]) for r in methods.values())])
    names = " / ".join(methods)
    return table(["scene", "vertices", f"best on rows of curvature: {names}", "of distance and silhouette", "of energy",
                  "iterations on the finest level"], rows, "lr")


def iterations_of_remedies():
    """Newton iterations of each remedy that is a choice: by small scene, and in the sum of the large ones."""
    small, large = {}, {}
    for r in read("hard_remedies.json"):
        scene, remedy = r["run"].split(", ", 1)
        name = plain_name(remedy)
        if r["sweep"] == "hard_remedies":
            small.setdefault(name, {})[scene.removeprefix("hard_")] = r["iterations"]
        else:
            large[name] = large.get(name, 0) + r["iterations"]
    return small, large


def remedies():
    small, large = iterations_of_remedies()
    scenes_of = list(next(iter(small.values())))
    rows = [[name] + [figure(of_scene.get(s)) for s in scenes_of] + [f"{large[name]:.0f}" if name in large else "–"]
            for name, of_scene in small.items()]
    return table(["Newton iterations", *scenes_of, "sphere, cube and tablecloth, PCS and direct"], rows, "lrrrr")


def of_large_scenes(*names):
    """Iterations on the large scenes by these remedies, over those by the defaults."""
    _, large = iterations_of_remedies()
    return lowest_to_highest([large[name] / large["defaults"] for name in names])


def of_small_scenes(name):
    small, _ = iterations_of_remedies()
    return lowest_to_highest([count / small["defaults"][scene] for scene, count in small[name].items()])


def named_ablations():
    """The runs by variation and method, and the direct solve's flops by the defaults."""
    return grouped(read("ablations.json"), "variant", "method"), of(runs("ablations", "newton", variant="as_it_is"), "tflop")


def over_defaults(value, *variants):
    """What these variations of the sphere's experiment have over its defaults, for each of the two methods that has both."""
    named, _ = named_ablations()
    return lowest_to_highest([value(named[v, m]) / value(named["as_it_is", m]) for v in variants for m in ("pcs", "cascadic") if (v, m) in named])


def ablations():
    """A row a method of each variation of the sphere's experiment; its flops are compared with the direct solve by the defaults."""
    named, direct = named_ablations()
    rows = []
    for variant in dict.fromkeys(v for v, _ in named):
        for method in [m for m in ("pcs", "pcs_loop", "cascadic", "newton") if (variant, m) in named]:
            r = named[variant, method]
            rows.append([plain_name(variant), method, ", ".join(figure(n) for n in iterations(r)), figure(of(r, "tflop") / direct, 2),
                         preview(r, "distance_rms")])
    return table(["variation", "method", "iterations by level", "total flops, relative to direct by the defaults", "preview: RMS distance [diagonals]"],
                 rows, "lllrr")


def decrements():
    """PCS and the direct solve of the dragon, levels ended at a decrement."""
    direct = {r["seed"]: r["seconds"] for r in runs("dragon_decrements", "newton")}
    rows = []
    for method in ("pcs", "newton"):
        r = runs("dragon_decrements", method)
        name = method if all(x["status"] in CONVERGED for x in r) else f"{method}, ended early"
        rows.append([name, ", ".join(figure(n) for n in iterations(r)), seconds_text([x["seconds_of_preview"] for x in r]),
                     seconds_text([x["seconds"] for x in r]), with_range([x["seconds"] / direct[x["seed"]] for x in r], lambda v: figure(v, 2)),
                     with_range([x["energy"] for x in r], lambda v: figure(v, 4)),
                     with_range([x["force_residual"] for x in r], lambda v: figure(v, 2))])
    return table(["method", "Newton iterations by level", "preview [s]", "total [s]", "relative to direct", "final energy [J]", "force residual"], rows, "llrrrrr")


def ratios():
    """Without phases that took no time; then a row a scene of steps on level 0 over direct coarse ones."""
    rows, steps = [], {}
    for r in read("ratios.json")["rows"]:
        scene, step, method = r["what"].partition(": level-0 step of ")
        if step:
            steps.setdefault(scene, {})[method] = figure(r["ratio"], 2)
        elif r["seconds"] > 0:
            rows.append([r["what"], r["against"], figure(r["ratio"], 2)])
    methods = list(next(iter(steps.values())))
    return (table(["what", "over", "ratio"], rows, "llr") + [""] +
            table(["level-0 step over a direct coarse one", *methods], [[scene, *of.values()] for scene, of in steps.items()], "l" + "r" * len(methods)))


def linear_solvers():
    """Seconds of one numeric factorisation by each solver, and what CHOLMOD's takes of ours."""
    rows = []
    for r in read("linear_solvers.json")["rows"]:
        own, cholmod = r["supernodal"], r["cholmod"]
        cell = lambda solver: f"{figure(solver['factorisation_seconds'], 2)} ({solver['gflops_per_second']:.0f})"  # noqa: E731
        ratios_of = r["cholmod_over_supernodal"]
        rows.append([r["scene"], str(r["vertices"]), str(r["threads"]), cell(own), cell(cholmod),
                     figure(ratios_of["factorisation"], 2), figure(ratios_of["solve"], 2)])
    return table(["scene", "vertices", "threads", "supernodal [s] (GFlop/s)", "cholmod [s] (GFlop/s)", "cholmod / supernodal",
                  "the same for a solve"], rows, "lrrrrrr")


def sum_of_changes(method, key):
    """Without what the start takes."""
    return sum(r[method][key] for r in read("changes.json")["rows"][1:])


def changes():
    rows = []
    for r in read("changes.json")["rows"]:
        cells = [r["change"].replace(" x ", " × ")]
        for method in ("pcs", "newton"):
            cells += [str(r[method]["iterations"]), figure(r[method]["seconds"], 2)]
        rows.append(cells)
    rows.append(["all but the start"] + [text for method in ("pcs", "newton") for text in (
        str(sum_of_changes(method, "iterations")), figure(sum_of_changes(method, "seconds")))])
    return table(["change", "PCS: Newton iterations", "s", "direct coarse: Newton iterations", "s"], rows, "lrrrr")


def python():
    """A run with a callback and a membrane in numpy, beside the command and the C++ membrane."""
    record = read("python.json")
    run, membrane = record["run"], record["membrane"]
    rows = [[f"a run with a callback for each iteration, {run['vertices']} vertices", *(figure(run[k]) for k in ("python", "cpp", "ratio"))]]
    rows += [[f"{what} of a membrane, {membrane['vertices']} vertices", *(figure(membrane[what][k]) for k in ("python", "cpp", "ratio"))]
             for what in ("value", "gradient", "hessian")]
    return table(["what", "Python [s]", "C++ [s]", "ratio"], rows, "lrrr")


def codim_ipc():
    """An energy that Codim-IPC has after its first time step may have been reached anywhere within that step."""
    two = lambda v: figure(v, 2)  # noqa: E731
    rows = []
    for (scene, vertices), starts in grouped(read("codim_ipc.json")["runs"], "scene", "vertices").items():
        row = [scene, str(vertices)]
        for key in ("seconds_per_iteration", "seconds_to_same_state"):
            bounded = key == "seconds_to_same_state" and any(r["codim_ipc"].get("seconds_a_step_before") == 0 for r in starts)
            ours, theirs = (seconds_text([r[program].get(key) for r in starts]) for program in ("drape", "codim_ipc"))
            ratio = with_range([r["codim_ipc"][key] / r["drape"][key] for r in starts if key in r["drape"]], two)
            row += [ours] + [f"at most {text}" if bounded else text for text in (theirs, ratio)]
        rows.append(row + [with_range([r.get("rms_distance") for r in starts], two)])
        for key, what in (("drape_one_level", "alone"), ("drape_to_rest", "to rest")):
            for r in (r for r in starts if key in r):
                ours, theirs = (r[program]["seconds_per_iteration"] for program in (key, "codim_ipc"))
                rows.append([scene, f"{vertices}, {what}", two(ours), two(theirs), two(theirs / ours), *4 * ["–"]])
    return table(["scene", "vertices", "iteration [s]: drape", "iteration [s]: Codim-IPC", "iteration: ratio", "to the same energy [s]: drape",
                  "to the same energy [s]: Codim-IPC", "to the same energy: ratio", "RMS distance of the final states [diagonals]"], rows, "lrrrrrrrr")


def energy_over_codim_ipc(scene):
    """How far drape's final energy is above Codim-IPC's, in % of the gravitational energy released, a thousandth of which is in
    `same_state`."""
    def percent(ours, theirs, target):
        return 0.1 * (ours - theirs) / (target - max(ours, theirs))

    found = [percent(r["drape"]["energy"], r["codim_ipc"]["energy"], r["same_state"])
             for r in read("codim_ipc.json")["runs"] if r["scene"] == scene and "same_state" in r]
    return lowest_to_highest(found)


def first_iterations(scene):
    """Number of Newton iterations of either program where only the beginning was run."""
    found = [r["codim_ipc"]["iterations"] for r in read("codim_ipc.json")["runs"] if r["scene"] == scene and "same_state" not in r]
    return str(found[0]) if len(set(found)) == 1 else f"{min(found)} to {max(found)}"


def beside(program, title):
    """The ends of drape and of another program in the two scenes of two_drapes.py."""
    two = lambda v: figure(v, 2)  # noqa: E731
    rows = []
    for scene, starts in grouped(read(f"{program}.json")["runs"], "scene").items():
        for key, name in (("drape", "drape"), (program, title)):
            ends = [r[key] for r in starts]
            at_rest = sum(r.get("at_rest", r["force_residual"] < 1e-3) for r in ends)  # drape by its residual alone
            rows.append([scene, name, seconds_text([r["seconds"] for r in ends]), f"{at_rest} of {len(starts)}",
                         with_range([r["force_residual"] for r in ends], two), str(sum(r["intersections"] > 0 for r in ends)),
                         with_range([r["largest_stretch"] for r in ends])])
    return table(["scene", "program", "CPU time [s]", "starts at rest", "force residual at the end", "starts with intersections", "largest stretch"],
                 rows, "llrrrrr")


def starks_linear_solvers():
    """How STARK solved its linear systems; records without a name are of conjugate gradients alone."""
    found = [r["stark"] for r in read("stark.json")["runs"]]
    if "linear_solver" not in found[0]:
        return "conjugate gradients alone, without its factorisations"
    counts = [f"{name} in {len(runs_of)} of {len(found)} runs" for name, runs_of in grouped(found, "linear_solver").items()]
    return f"the faster of conjugate gradients and factorisations: {', '.join(counts)}"


def exponent(records, value):
    """Of the number of vertices, by least squares of logarithms."""
    points = [(math.log(r["vertices"]), math.log(value(r))) for r in records if value(r)]
    return figure(statistics.linear_regression(*zip(*points)).slope) if len(points) > 1 else "–"


def scale():
    """Exponents are those of the levels with multigrid, from 20,000 vertices on. Only a factorisation analyses a pattern."""
    records = read("scale.json")["rows"]
    multigrid = [r for r in records if r["vertices"] >= 20000]
    by_factorisation = lambda r: "all" if r not in multigrid else "some" if "analyse" in r["by_phase"] else "none"  # noqa: E731
    rows = [[str(r["vertices"]), figure(r["iterations"]), by_factorisation(r), figure(r["seconds"], 2), figure(r["total_seconds"], 3),
             figure(r["peak_bytes"] / 1e9, 2)] for r in records]
    rows.append(["exponent", "", "", exponent(multigrid, itemgetter("seconds")), "", exponent(multigrid, itemgetter("peak_bytes"))])
    lines = table(["vertices", "iterations", "of these by a factorisation", "seconds per iteration", "seconds of all levels", "peak memory [GB]"],
                  rows, "rrlrrr")
    largest = records[-1]
    phases = sorted(largest["by_phase"].items(), key=lambda p: -p[1])
    rows = [[phase, figure(100 * s / largest["seconds"], 2), exponent(multigrid, lambda r, phase=phase: r["by_phase"].get(phase))]
            for phase, s in phases if s > 0.005 * largest["seconds"]]
    return lines + [""] + table([f"phase, at {largest['vertices']} vertices", "% of an iteration", "exponent"], rows, "lrr")


STUDIES = [
    ("[sphere to 98K](previews.md#the-sphere-to-98k-vertices)", "sphere.md"),
    ("[whole command](speed.md#the-whole-command)", "whole_command.json"),
    ("[ratios](speed.md#ratios)", "ratios.json"),
    ("[changes](speed.md#changes-of-a-parameter)", "changes.json"),
    ("[linear solvers](speed.md#the-linear-solver)", "linear_solvers.json"),
    ("[Python](../extend/from-python.md#what-it-costs)", "python.json"),
    ("[beside Codim-IPC](speed.md#beside-codim-ipc)", "codim_ipc.json"),
    ("[beside STARK](speed.md#beside-stark)", "stark.json"),
    ("[beside Blender](speed.md#beside-blender)", "blender.json"),
    ("[scale](speed.md#scale)", "scale.json"),
    ("[six scenes to 5.9K](previews.md#six-scenes)", "previews.md"),
    ("[four levels](previews.md#four-levels)", "four_levels.md"),
    ("[fine meshes](previews.md#fine-meshes)", "fine_meshes.md"),
    ("[garments](previews.md#garments)", "garments.md"),
    ("[ablations](ablations.md#one-choice-at-a-time)", "ablations.md"),
    ("[hard cases](hard-cases.md)", "hard.md"),
    ("[remedies](ablations.md#newton)", "hard_remedies.md"),
    ("[drape coefficients](validation.md#cusicks-drape-test)", "cusick.csv"),
    ("[Table 1](table1.md)", "table1.md"),
    ("[scenes](speed.md#every-scene)", "scenes.md"),
    ("[the dragon, by decrements](speed.md#levels-that-end-at-a-decrement)", "dragon_decrements.md"),
]


def studies():
    minutes = lambda record: seconds_text([stamps()["records"].get(record, {}).get("minutes")])  # noqa: E731
    rows = [[title, f"[{record}](../../benchmarks/results/{record})", minutes(record)]
            for title, record in STUDIES if (RESULTS / record).exists()]
    return table(["study, whose section has its conditions", "record", "minutes"], rows, "llr")


def solves(*names):
    """Number of solves with contact of studies, and of intersections at the end of their levels."""
    records = [r for name in names for r in read(f"{name}.json") if r["scene"] not in WITHOUT_CONTACT]
    return len(records), sum(r["intersections"] for r in records)


def scene_names(study):
    return dict.fromkeys(r["scene"] for r in read(f"{study}.json"))


def medians_over(other, study, value):
    """PCS's median over another method's, by scene."""
    return {name: median([value(r) for r in finished(study, "pcs", name, "default")])
            / median([value(r) for r in finished(study, other, name)]) for name in scene_names(study)}


def scenes_above(study, value, other="cascadic"):
    """Those on which PCS has more than another method, and how many times as much."""
    found = [f"{name} ({figure(ratio)})" for name, ratio in medians_over(other, study, value).items() if ratio > 1]
    return " and ".join([", ".join(found[:-1]), found[-1]] if len(found) > 1 else found) or "no scene"


def where_cascadic_is_better():
    """A row a cost, a column a study: the scenes on which PCS has more of it than the cascadic method."""
    return table(["more by PCS", *STUDIES_OF_SCENES.values()],
                 [[what, *(scenes_above(study, value) for study in STUDIES_OF_SCENES)] for what, value in COSTS.items()], "")


def times_as_far(study):
    """The range over its scenes of the cascadic preview's distance over PCS's; the lowest by hundredths, since 1.15 is not 1.2."""
    ratios = [1 / ratio for ratio in medians_over("cascadic", study, PREVIEW_DISTANCE).values()]
    return f"{min(ratios):.2f} to {figure(max(ratios), 2)}"


def number_above(study, value, other="cascadic"):
    ratios = medians_over(other, study, value).values()
    return f"{sum(ratio > 1 for ratio in ratios)} of {len(ratios)}"


def drape_coefficient(fabric):
    rows = csv.DictReader((RESULTS / "cusick.csv").read_text().splitlines())
    return with_range([float(r["drape_coefficient"]) for r in rows if r["run"] == fabric], lambda v: f"{v:.1f}")


def longer_changes():
    """Of the changes after the start, the number on which PCS takes more iterations than the direct coarse model."""
    after = read("changes.json")["rows"][1:]
    return f"{sum(r['pcs']['iterations'] > r['newton']['iterations'] for r in after)} of {len(after)}"


def pins_meet(key):
    """The values of the hard case "pins meet" by all methods."""
    return sorted({r[key] for r in read("hard.json") if r["run"] == "pins meet"})


def row_count(name):
    """Rows of a table of runs and how many pass; no state of them may be missing."""
    rows = read(name)
    return f"{sum(r['pass'] for r in rows)} of {len(rows)}"


TOP = ["preview, RMS: pcs / cascadic", "overlap", "finest level, iterations: pcs / cascadic / direct",
       "total flops, relative to direct: pcs / cascadic", "final energy, pcs minus cascadic, start by start [J]"]

BLOCKS = {
    "sphere in full": lambda: sphere(["iterations", "preview [s]", "total [s]", "total flops, relative to direct",
                                      "final energy [J]", "preview: RMS distance from the final state [diagonals]", "silhouette overlap",
                                      "preview: energy above the final state [J]", "level 1: RMS distance"]),
    "six scenes in full": lambda: scenes("previews", TOP),
    "four levels": lambda: scenes("four_levels", [
        TOP[0], "overlap", "finest level, iterations: pcs / cascadic", "total flops, relative to cascadic", TOP[-1]]),
    "garments": lambda: scenes("garments", [TOP[0], "overlap", "finest level, iterations: pcs / cascadic", TOP[-1]]),
    "fine meshes": fine_meshes,
    "table 1": table1,
    "remedies": remedies,
    "ablations": ablations,
    "decrements": decrements,
    "ratios": ratios,
    "changes": changes,
    "linear solvers": linear_solvers,
    "python": python,
    "codim_ipc": codim_ipc,
    "blender": lambda: beside("blender", "Blender"),
    "stark": lambda: beside("stark", "STARK"),
    "scale": scale,
    "studies": studies,
    "where cascadic is better": where_cascadic_is_better,
}

def median_seconds(method, key):
    return seconds_text([of(finished("sphere", method), key)])


VALUES = {
    "sphere.vertices": lambda: f"{runs('sphere', 'pcs')[0]['vertices'] / 1000:.0f}K",
    "sphere.seen": lambda: median_seconds("pcs", "seconds_of_preview"),
    "sphere.finished": lambda: median_seconds("pcs", "seconds"),
    "sphere.cascadic": lambda: median_seconds("cascadic", "seconds"),
    "whole command, median [s]": lambda: figure(median([r["seconds"] for r in read("whole_command.json")["runs"]]), 2),
    "whole command [s]": lambda: seconds_text([r["seconds"] for r in read("whole_command.json")["runs"]]),
    **{f"whole command over its levels, {what}": lambda key=key: figure(
        median([r[key] / r[f"{key}_of_levels"] for r in read("whole_command.json")["runs"]])) for what, key in (("time", "seconds"), ("CPU time", "cpu_seconds"))},
    "sphere.distance": lambda: figure(100 * distance_of_previews(finished("sphere", "pcs")), 2),
    "sphere.distance_ratio": lambda: figure(
        distance_of_previews(finished("sphere", "cascadic")) / distance_of_previews(finished("sphere", "pcs")), 2),
    "previews.distance": lambda: lowest_to_highest([
        100 * distance_of_previews(finished("previews", "pcs", name, "default")) for name in scene_names("previews")]),
    "previews, distance_ratio": lambda: times_as_far("previews"),
    "garments, distance_ratio": lambda: times_as_far("garments"),
    "garments, share of the preview [%]": lambda: lowest_to_highest([
        100 * median([r["seconds_of_preview"] / r["seconds"] for r in finished("garments", "pcs", name)]) for name in scene_names("garments")]),
    "garments, higher ends": lambda: starts_above("garments", itemgetter("energy")),
    **{f"garments.{key}": lambda value=value: lowest_to_highest([of(finished("garments", "pcs", name), value) for name in scene_names("garments")])
       for key, value in (("seen", "seconds_of_preview"), ("finished", "seconds"))},
    "garments.number": lambda: str(len(scene_names("garments"))),
    "sphere, previews": lambda: lowest_to_highest(start_by_start("sphere", PREVIEW_DISTANCE)),
    "sphere, level 1": lambda: lowest_to_highest(start_by_start("sphere", lambda r: r["level_1"]["distance_rms"])),
    "sphere, time to the preview": lambda: lowest_to_highest(start_by_start("sphere", lambda r: r["seconds_of_preview"])),
    "sphere, later previews": lambda: starts_above("sphere", lambda r: r["seconds_of_preview"]),
    "sphere, time to the end": lambda: lowest_to_highest(start_by_start("sphere", lambda r: r["seconds"])),
    "previews, flops over direct from single starts": lambda: lowest_to_highest(start_by_start("previews", TFLOP, "newton")),
    "previews, more flops than direct": lambda: scenes_above("previews", TFLOP, "newton"),
    **{f"previews, nearer by energy: {other}": lambda other=other: number_above("previews", COSTS["energy of the preview above its end"], other)
       for other in ("cascadic", "pcs_loop")},
    "flops from single starts": lambda: lowest_to_highest(start_by_start("previews", TFLOP)),
    **{f"drape coefficient of {fabric}": lambda fabric=fabric: drape_coefficient(fabric) for fabric in FABRICS},
    "sphere.direct": lambda: median_seconds("newton", "seconds"),
    "usual conditions": usual_conditions,
    **{f"conditions of {name}": lambda name=name: conditions(name) for _, name in STUDIES},
    "sphere.cascadic_seen": lambda: median_seconds("cascadic", "seconds_of_preview"),
    **{f"{study}, slower": lambda study=study: number_above(study, COSTS["time to the end"]) for study in STUDIES_OF_SCENES},
    "slowest": lambda: figure(max(ratio for study in STUDIES_OF_SCENES for ratio in medians_over("cascadic", study, COSTS["time to the end"]).values()), 2),
    "iterations of the coarse matrix": lambda: lowest_to_highest([matrix / galerkin for matrix, galerkin in zip(
        *(iterations(runs("ablations", "pcs_loop", variant=variant))[:-1] for variant in ("coarse_matrix", "as_it_is")))]),
    **{f"{what}, {measure} over the defaults": lambda variants=variants, value=value: over_defaults(value, *variants)
       for what, variants in (("not relaxed", ["not_relaxed"]), ("first step of 0.01 s", ["step_size_0.01_s"]),
                              ("tolerance and step size", TOLERANCES_AND_STEPS),
                              ("other tolerances and steps", [v for v in TOLERANCES_AND_STEPS if v != "step_size_0.01_s"]))
       for measure, value in (("distance", distance_of_previews), ("flops", lambda r: of(r, "tflop")))},
    "flops of the coarse matrix over direct": lambda: figure(of(runs("ablations", "pcs_loop", variant="coarse_matrix"), "tflop") / named_ablations()[1], 2),
    "near the defaults, large scenes": lambda: of_large_scenes("absolute, adaptive", "step size 1", "static", "step growth 3"),
    "full or no projection, large scenes": lambda: of_large_scenes("clamp, full", "absolute, full", "no projection"),
    "κ ten times, small scenes": lambda: of_small_scenes("κ ten times"),
    **{f"{method} on the pinned square, distance": lambda method=method, variant=variant: figure(
        distance_of_previews(finished("previews", method, "pinned_square", variant)) / distance_of_previews(finished("previews", "cascadic", "pinned_square")), 2)
       for method, variant in (("pcs", "default"), ("pcs_loop", None))},
    "changes with more iterations": longer_changes,
    **{f"{key} of all changes": lambda key=key: " and ".join(figure(sum_of_changes(method, key)) for method in ("pcs", "newton"))
       for key in ("iterations", "seconds")},
    "milliseconds of a load": lambda: lowest_to_highest([r["load_milliseconds"] for r in read("changes.json")["rows"]]),
    "pins meet, gap": lambda: figure(pins_meet("smallest_gap")[0], 2),
    "pins meet, status": lambda: " or ".join(pins_meet("status")),
    **{f"drape's energy over Codim-IPC's, {scene} [%]": lambda scene=scene: energy_over_codim_ipc(scene) for scene in TWO_DRAPES},
    **{f"first iterations beside Codim-IPC, {scene}": lambda scene=scene: first_iterations(scene) for scene in TWO_DRAPES},
    "processor of CHOLMOD's BLAS": lambda: read("linear_solvers.json")["blas_kernels"],
    "processor of Codim-IPC's BLAS": lambda: read("codim_ipc.json")["runs"][0]["codim_ipc"]["blas_kernels"],
    "iterations of STARK over drape's": lambda: lowest_to_highest(
        [r["stark"]["iterations"] / r["drape"]["iterations"] for r in read("stark.json")["runs"]]),
    "linear solvers of STARK": starks_linear_solvers,
    **{f"{study}.solves": lambda study=study: str(solves(study)[0]) for study in ("sphere", "previews", "garments")},
    "dragon.minutes": lambda: minutes_of("dragon"),
    "scale.vertices": lambda: f"{read('scale.json')['rows'][-1]['vertices'] / 1000:.0f}K",
    "scale.minutes": lambda: figure(read("scale.json")["rows"][-1]["total_seconds"] / 60, 2),
    "scale.memory": lambda: figure(read("scale.json")["rows"][-1]["peak_bytes"] / 1e9, 2),
    "scenes of 94K to 98K [s]": lambda: seconds_of_scenes(93_500, 98_500),
    "sphere on one core [s]": lambda: f'{float(scene_row("sphere")["seconds"]):.0f}',
    "limp.vertices": lambda: f"{int(scene_row('sphere_fine')['vertices']) / 1000:.0f}K",
    "limp.minutes": lambda: minutes_of("sphere_fine"),
    "crossings": lambda: str(solves("sphere", "previews", "garments")[1]),
    "hard cases that pass": lambda: row_count("hard.json"),
    "hard cases at rest": lambda: str(sum(r["status"] == "converged" for r in read("hard.json"))),
    "remedies that pass": lambda: row_count("hard_remedies.json"),
}
