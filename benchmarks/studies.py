"""The studies of `make results`, in the order in which they run.

A study: `what` it is; the `minutes` that it may take, over all calls, on two cores; whether its times are compared (`timed`: one
process at a time, all cores, on an idle machine) or only its iterations and flops (one thread a run, a run a core); the `threads`
of a timed one that does not take all cores; `starts`; the commands that `run` it in {out}, which go on where they were cut; those
that `gather` its records, a first word ">FILE" storing what the rest prints; its `records` in benchmarks/results; `meshes` of
data/ that it needs; what else it `needs` in {build}, and how to get it; a command that is to `check` what others have built, and
says what is missing; whether it takes so long that it runs only when it is `named`; whether a run that is refused, or exceeds its
sweep's time limit, is one of the `failures` that it records; whether what `gather` prints is a table of `scenes`, of which those
are recorded that have run.
"""

MESHES = ["bunny.ply", "armadillo.ply"]
ALL_MESHES = [*MESHES, "bear.ply", "dragon.ply"]
MODULE = {"python/drape": "the Python module: run `make python`"}
RUN_COLUMNS = "run,status,vertices,steps,seconds,energy_released,smallest_gap,largest_stretch,intersections,d_H_fit,message"


def sweep(name, folder="configs/sweeps", out="{out}"):
    return ["{drape}", "sweep", f"{folder}/{name}.yaml", "-o", out, "-j", "{workers}", "--threads", "{threads}", "-q"]


def previews(name, what, minutes, starts=3, timed=False, meshes=()):
    return {"what": what, "minutes": minutes, "timed": timed, "starts": starts, "meshes": list(meshes), "run": [sweep(name)],
            "gather": [["benchmarks/previews", name, "{out}"]], "records": [f"{name}.json", f"{name}.md"]}


def dressed(name, what, minutes):
    """Published patterns too where GARMENTCODE names a clone of GarmentCode."""
    return previews(name, what, minutes) | {
        "failures": True, "run": [["benchmarks/garments/dress", "{drape}", "{out}", "{workers}"]],
        "gather": [["benchmarks/previews", name, "{out}/sweep"]]}


def one_record(name, what, minutes, *command):
    """A timed study whose command writes the record."""
    file = "{out}/" + name + ".json"
    return {"what": what, "minutes": minutes, "timed": True, "run": [[*command, file]], "gather": [["cp", file, "{results}/"]],
            "records": [f"{name}.json"]}


def program(name, what, minutes):
    return one_record(name, what, minutes, "{build}/bin/drape_bench_" + name)


def beside(name, title, minutes, check):
    """A comparison with another program, which is to be there."""
    return one_record(name, f"direct Newton beside {title}", minutes, "env", "PYTHONPATH={build}/python", f"benchmarks/{name}/compare") | {
        "threads": 1, "starts": 3, "needs": MODULE, "check": check}


HARD = ["closing", "contact", "dragged", "folded", "friction", "material", "mesh", "pins", "remedies", "remedies_draped",
        "same_shape", "sleeve", "steps", "time"]

STUDIES = {
    "sphere": previews("sphere", "the sphere to 98K vertices, three methods", 30, timed=True),
    "ratios": program("ratios", "parts of an iteration against each other", 15),
    "whole_command": one_record("whole_command", "the whole command beside its levels", 10, "benchmarks/whole_command", "{drape}", "{threads}") | {
        "starts": 1},
    "changes": program("changes", "what a change of a parameter costs", 10),
    "linear_solvers": program("linear_solvers", "both linear solvers on the same matrices", 15) | {
        "check": ["sh", "-c", "ldd {build}/bin/drape_bench_linear_solvers | grep -q openblas || echo 'OpenBLAS as the BLAS: run third_party/setup compare, "
                          "or choose it by update-alternatives' >&2"]},
    "python": one_record("python", "what the Python module costs", 5, "env", "PYTHONPATH={build}/python", "/usr/bin/python3",
                         "benchmarks/python", "{drape}") | {"needs": MODULE},
    "codim_ipc": beside("codim_ipc", "Codim-IPC", 60, ["benchmarks/codim_ipc/installation.py"]),
    "stark": beside("stark", "STARK", 20, [
        "sh", "-c", "test -x \"$STARK/simulate\" || echo 'STARK: name the folder in which benchmarks/stark/CMakeLists.txt was built' >&2"]),
    "blender": beside("blender", "Blender's cloth", 15, [
        "sh", "-c", "command -v blender >/dev/null || echo 'Blender: run third_party/setup compare' >&2"]),
    "scale": {
        "what": "an iteration by the number of vertices, 16K to a million", "minutes": 20, "timed": True, "starts": 1,
        "run": [sweep("scale") + ["--allow-memory"]],
        "gather": [["benchmarks/scale", "{out}", "{results}/scale.json"]], "records": ["scale.json"]},
    "dragon_decrements": previews("dragon_decrements", "the dragon to 371K vertices under the paper's rule for ending levels", 30, starts=1,
                                  timed=True, meshes=["dragon.ply"]),
    "previews": previews("previews", "six scenes to 5.9K vertices", 35, meshes=MESHES),
    "four_levels": previews("four_levels", "six scenes with a fourth level", 50, meshes=MESHES),
    "fine_meshes": previews("fine_meshes", "coarser levels under a given mesh", 75, meshes=MESHES),
    "garments": dressed("garments", "garments on a body", 60),
    "ablations": previews("ablations", "one choice changed at a time", 20),
    "hard": {
        "what": "the hard cases", "minutes": 30, "timed": False, "starts": 1, "failures": True,
        "run": [sweep(name, "configs/hard/sweeps", "{out}/" + name) for name in HARD],
        "gather": [["configs/hard/write_tables", "{drape}", "{out}", "{results}"]],
        "records": ["hard.json", "hard.md", "hard_remedies.json", "hard_remedies.md"]},
    "cusick": {
        "what": "drape coefficients of fabrics", "minutes": 20, "timed": False, "starts": 5, "run": [sweep("cusick")],
        "gather": [[">{results}/cusick.csv", "{drape}", "table", "{out}", "--format", "csv", "--columns",
                    "run,seed,status,drape_coefficient,folds,intersections"]], "records": ["cusick.csv"]},
    "table1": {
        "what": "two scenes of the supplement's Table 1", "minutes": 60, "timed": False, "starts": 1, "run": [sweep("table1")],
        "gather": [["benchmarks/table1", "{out}", "{results}/table1"]], "records": ["table1.json", "table1.md"]},
    "scenes": {
        "what": "scenes of the supplement's Table 2, to their finest levels", "minutes": 240, "timed": False, "starts": 1, "meshes": ALL_MESHES,
        "named": True, "run": [sweep("scenes")], "scenes": True,
        "gather": [[">{results}/scenes.md", "{drape}", "table", "{out}", "--columns", RUN_COLUMNS]], "records": ["scenes.md"]},
}
