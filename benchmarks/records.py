"""Stored records, benchmarks/results/*, and the stamps that say how each was made (results/stamps.json)."""

import json
import statistics
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks/results"
CONVERGED = ["converged", "converged_to_rounding"]
IDLE_LOAD = 0.3  # [cores] that others may keep busy before a study begins
# One experiment under two names: the second is not run again, and shares the first one's record.
TWINS = {"triangulation_1": "materials_2", "materials_3": "sphere_fine"}
# No contact model looks for their intersections.
WITHOUT_CONTACT = ["pinned_square", "pinned_square_interior"]


def figure(value, digits=3):
    return "–" if value is None else f"{value:.{digits}g}".replace("e-0", "e-").replace("e+0", "e")


def median(values):
    known = [v for v in values if v is not None]
    return statistics.median(known) if known else None


def with_range(values, text=figure):
    """The median, with the range in brackets where the values differ."""
    values = [v for v in values if v is not None]
    if not values:
        return "–"
    low, high = text(min(values)), text(max(values))
    return text(median(values)) + (f" ({low}–{high})" if low != high else "")


def seconds_text(values):
    """Two digits, or whole seconds from a hundred on."""
    return with_range(values, lambda v: figure(v, 2) if v < 99.5 else f"{v:.0f}")


def read(name):
    return json.loads((RESULTS / name).read_text())


def write_json(path, value):
    path.write_text(json.dumps(value, indent=1, ensure_ascii=False) + "\n")


def count(n, what):
    """"1 start", "3 starts"."""
    return f"{n} {what}" + ("" if n == 1 else "s")


def stamps():
    """{"build": the commit of the last `make results`, "records": {name: stamp}}."""
    return read("stamps.json")


def machine(stamp):
    """"Intel Xeon with 2 cores"."""
    cpu = stamp["cpu"].replace("(R)", "").replace(" Processor", "") + (" (AVX-512)" if stamp.get("avx512") else "")
    return cpu + (f" with {count(stamp['cores'], 'core')}" if stamp.get("cores") else "")


def usual_machine():
    """That of most records."""
    machines = [machine(stamp) for stamp in stamps()["records"].values() if stamp.get("cpu")]
    return max(sorted(set(machines)), key=machines.count, default="")


def usual_conditions():
    """What conditions() leaves out."""
    return f"{usual_machine()}, commit {stamps()['build']}"


def conditions(name):
    """A record's stamp in words, but for the usual conditions: "3 starts, 2 threads, Intel Xeon with 2 cores"."""
    all_stamps = stamps()
    stamp = all_stamps["records"].get(name)
    if stamp is None:
        return "no record yet"
    parts = [count(stamp["starts"], "start")] if stamp.get("starts") else []
    parts += [count(stamp["threads"], "thread")] if stamp.get("threads") else []
    if stamp.get("cpu") and machine(stamp) != usual_machine():
        parts.append(machine(stamp))
    if not stamp.get("commit"):
        parts.append(stamp.get("note", "build not recorded"))
    elif stamp["commit"] != all_stamps["build"]:
        parts.append(f"commit {stamp['commit']}, another build")
    if stamp.get("runs_at_a_time", 1) > 1:
        parts.append(f"{stamp['runs_at_a_time']} runs at a time")
        if stamp["load_after"] >= own_load(stamp) + 0.5:
            parts.append(f"beside other work (load {figure(stamp['load_after'], 2)} after)")
    elif stamp.get("load_before") is not None and not idle(stamp):
        when = "before" if stamp["load_before"] >= IDLE_LOAD else "after"
        parts.append(f"beside other work (load {figure(stamp['load_' + when], 2)} {when})")
    elif stamp.get("busy"):
        parts.append("beside other work")
    if stamp.get("complete") is False:
        parts.append("not complete")
    return ", ".join(parts)


def record_files():
    """Every file in benchmarks/results that is a record, by its name in stamps.json."""
    found = {str(f.relative_to(RESULTS)) for f in RESULTS.rglob("*") if f.is_file()}
    return sorted(found - {"stamps.json"})


def own_load(stamp):
    return stamp["threads"] * stamp.get("runs_at_a_time", 1)


def idle(stamp):
    """Nothing else ran before, nor, but for the study's own threads, at its end."""
    return stamp["load_before"] < IDLE_LOAD and stamp["load_after"] < own_load(stamp) + 0.5
