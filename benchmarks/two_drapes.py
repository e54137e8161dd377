"""Two scenes on which other programs stand beside drape: a square that hangs from its corners, and one over a ball."""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import numpy

import drape

SEEDS = (1, 2, 3)
COTTON = {"density": 472.6, "thickness": 3.18e-4, "poisson_ratio": 0.243}
SCENES = {
    "hanging": {  # pinned at its corners, which are pulled together
        "material": {**COTTON, "membrane_modulus": 3e5, "bending_modulus": 3e5}, "start": {"scale": [0.8, 0.8, 1]},
        "pins": [[0, 0], [1, 0], [1, 1], [0, 1]], "contact": False},
    "draped": {  # over a ball, pinned at the centre: without friction it would slide off
        "material": {**COTTON, "membrane_modulus": 8e4, "bending_modulus": 8e5}, "start": {"translate": [-0.5, -0.5, 0.302]},
        "pins": [[0.5, 0.5]], "contact": True},
}
DHAT = 1e-3  # m
BALL = {"name": "ball", "meshed_shape": "sphere", "radius": 0.3, "subdivisions": 4}


def experiment_of(name, side, seed, levels=1):
    """Its finest level has side × side vertices: the same mesh and energy for every number of levels, but vertices are numbered, and
    the start's noise drawn, in another order."""
    spec, coarsest = SCENES[name], (side - 1) // 2 ** (levels - 1) + 1
    return drape.Experiment({
        "name": name, "cloth": {"shape": "square", "side": 1, "triangulation": "one_way", "columns": coarsest, "rows": coarsest},
        "levels": levels, "material": spec["material"], "start": {**spec["start"], "perturbation": 1e-3, "seed": seed},
        "pins": [{"region": "nearest", "point": [*point, 0]} for point in spec["pins"]],
        "energies": ["neo_hookean", "hinge", "gravity"], "newton": {"force_tolerance": 1e-3}, "methods": {"newton": {}},
        "metrics": [], **({"contact": [{"type": "ipc", "dhat": DHAT}], "obstacles": [BALL]} if spec["contact"] else {})})


def obstacle_mesh(scene, folder):
    """The ball's vertices and triangles, none in a scene without. A run writes its obstacles as meshes; read as a cloth, one has
    its arrays in Python."""
    if not SCENES[scene]["contact"]:
        return numpy.empty((0, 3)), numpy.empty((0, 3), int)
    experiment_of(scene, 3, SEEDS[0]).run(out=folder, progress=False)
    ball = drape.Experiment({"name": "ball", "cloth": {"shape": "file", "file": str(folder / "obstacles/0.ply")}, "levels": 1,
                             "energies": ["gravity"], "methods": {"newton": {}}})
    level = ball.scene()[0].level
    return level.rest, level.triangles


def solved(experiment, most=0):
    """CPU seconds and positions after each iteration of drape's Newton method on the finest level, at most so many if any, and the
    level at its end. The method solves each level from the scene's start."""
    solve, seconds, states = experiment.solver("newton"), [], []
    finest = len(solve.scene) - 1
    begin = time.process_time()
    for iteration in solve:
        if iteration.level < finest:
            begin = time.process_time()
            continue
        seconds.append(time.process_time() - begin)
        states.append(iteration.x.copy())
        if most and len(states) >= most:
            solve.stop()
    return seconds, states, solve.levels[-1]


def largest_stretch(rest, x, triangles):
    """The largest principal stretch; the rest shape is flat in z = 0."""
    edges = lambda p: numpy.stack([p[triangles[:, k]] - p[triangles[:, 0]] for k in (1, 2)], axis=2)  # noqa: E731
    deformation = edges(x) @ numpy.linalg.inv(edges(rest)[:, :2, :])
    return float(numpy.linalg.svd(deformation, compute_uv=False).max())


def end_state(model, seconds, residual, x):
    """What is compared of a program's last state: seconds to it, net force over the weight, and of the cloth what drape finds there."""
    return {"seconds": seconds, "force_residual": residual, "intersections": len(model.intersections(x)),
            "largest_stretch": largest_stretch(model.level.rest, x, model.level.triangles)}


def drape_end(scene, vertices, seed):
    """The scene's level, its start, and the end of drape's Newton method there."""
    experiment = experiment_of(scene, round(vertices**0.5), seed)
    levels = experiment.scene()
    seconds, states, level = solved(experiment)
    end = end_state(levels[0], seconds[-1], level.force_residual, states[-1])
    return levels[0], levels.start(0), {**end, "iterations": len(seconds)}


def commit_of(folder):
    """The commit of another program's sources, None where they are not in a Git tree."""
    return subprocess.run(["git", "-C", folder, "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True).stdout.strip() or None


def cases(*vertices):
    """Each scene with each number of vertices, start by start."""
    return [{"scene": scene, "vertices": n, "seed": seed} for seed in SEEDS for n in vertices for scene in SCENES]


def measure_all(out, about, cases, measure):
    """Measures each case that `out` does not have, and stores it. A case: the values that name it; `measure` gets them, and a folder."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # an exception, on which the other program ends too
    done = json.loads(out.read_text())["runs"] if out.exists() else []
    for case in cases:
        if any(case.items() <= run.items() for run in done):
            continue
        with tempfile.TemporaryDirectory(prefix="drape_") as folder:
            done.append(case | measure(**case, folder=pathlib.Path(folder)))
        part = out.with_suffix(".part")
        part.write_text(json.dumps({**about, "version": drape.__version__, "commit": drape.__commit__, "runs": done}, indent=1) + "\n")
        part.replace(out)
        print(*case.values(), file=sys.stderr, flush=True)
