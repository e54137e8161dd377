"""Two scenes on which other programs stand beside drape: a square that hangs from its corners, and one over a ball."""

import time

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


def experiment_of(name, side, seed):
    spec = SCENES[name]
    return drape.Experiment({
        "name": name, "cloth": {"shape": "square", "side": 1, "triangulation": "one_way", "columns": side, "rows": side}, "levels": 1,
        "material": spec["material"], "start": {**spec["start"], "perturbation": 1e-3, "seed": seed},
        "pins": [{"region": "nearest", "point": [*point, 0]} for point in spec["pins"]],
        "energies": ["neo_hookean", "hinge", "gravity"], "newton": {"force_tolerance": 1e-3}, "methods": {"newton": {}},
        "metrics": [], **({"contact": [{"type": "ipc", "dhat": DHAT}], "obstacles": [BALL]} if spec["contact"] else {})})


def obstacle_mesh(folder):
    """The ball's vertices and triangles. A run writes its obstacles as meshes; read as a cloth, one has its arrays in Python."""
    experiment_of("draped", 3, SEEDS[0]).run(out=folder, progress=False)
    ball = drape.Experiment({"name": "ball", "cloth": {"shape": "file", "file": str(folder / "obstacles/0.ply")}, "levels": 1,
                             "energies": ["gravity"], "methods": {"newton": {}}})
    level = ball.scene()[0].level
    return level.rest, level.triangles


def solved(experiment, most=0):
    """CPU seconds and positions after each iteration of drape's Newton method, at most so many if any, and the level at its end."""
    solve, seconds, states = experiment.solver("newton"), [], []
    begin = time.process_time()
    for iteration in solve:
        seconds.append(time.process_time() - begin)
        states.append(iteration.x.copy())
        if most and len(states) >= most:
            solve.stop()
    return seconds, states, solve.levels[0]
