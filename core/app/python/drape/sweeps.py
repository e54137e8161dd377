"""Sweeps from Python, by the command's engines."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
import tempfile
from typing import Any, Dict, Mapping, Optional, Sequence, Union

import pandas

from . import _core
from .experiment import Experiment
from .result import read_sweep


def _command() -> pathlib.Path:
    here = pathlib.Path(__file__).absolute().parent  # in a wheel, a build tree, or lib/python3/dist-packages
    places = [here / "bin/drape", here.parents[1] / "bin/drape", here.parents[3] / "bin/drape"]
    found = next((place for place in places if place.is_file()), None)
    if found is None:
        raise RuntimeError(f"there is no command drape beside the module: {', '.join(map(str, places))}")
    return found


def sweep(
    experiment: Union[Experiment, str, os.PathLike, Dict[str, Any]],
    grid: Optional[Mapping[str, Sequence[Any]]] = None,
    starts: Union[int, Sequence[int]] = 1,
    *,
    out: Union[str, os.PathLike],
    methods: Union[str, Sequence[str], None] = None,
    workers: Optional[int] = None,
    threads: int = 1,
    engine: str = "local",
    progress: bool = True,
) -> pandas.DataFrame:
    """Run every combination of a grid from several starts, and return `drape.read_sweep(out)`: a row for each method of each run.

    grid: values by the paths of keys, as {"friction": [0.1, 0.4]}; without, the experiment alone.
    starts: how many seeds, or which ones.
    out: the sweep's folder. The same call runs what is missing there, also after Ctrl-C, which saves the runs under way.
    methods: their names; None for all. workers: concurrent runs; None for as many as the cores allow.
    engine: "local" or "slurm", whose jobs are waited for.

    Each run is a process of the command, which compiles and loads what `load_plugin` has loaded, and does not know
    prototypes of this process. Raises RuntimeError for what the
    command refuses; runs that fail or do not converge are rows with that status.
    """
    base = experiment if isinstance(experiment, Experiment) else Experiment(experiment)
    resolved = base.resolved
    seeds: dict = {"repeats": starts} if isinstance(starts, int) else {"seeds": list(starts)}
    plan: dict = {"name": resolved["name"], "base": "base.yaml", "threads": threads, **seeds}
    plan |= {"methods": [methods] if isinstance(methods, str) else list(methods)} if methods else {}
    plan |= {"ablation": {"grid": {key: list(values) for key, values in grid.items()}}} if grid else {}
    with tempfile.TemporaryDirectory(prefix="drape_sweep_") as folder:
        for name, content in (("base.yaml", resolved), ("sweep.yaml", plan)):  # JSON is YAML too
            pathlib.Path(folder, name).write_text(json.dumps(content), encoding="utf-8")
        call = [str(_command()), "sweep", f"{folder}/sweep.yaml", "--out", os.fspath(out), "--engine", engine]
        call += [word for source in _core._plugin_sources() for word in ("--plugin", source)]
        call += (["--workers", str(workers)] if workers else []) + (["--wait"] if engine == "slurm" else []) + ([] if progress else ["-q"])
        with subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=None if progress else subprocess.PIPE, text=True) as process:
            interrupted = False
            while True:  # the command gets Ctrl-C too, and needs a moment to save
                try:
                    said = process.communicate()[1]
                    break
                except KeyboardInterrupt:
                    interrupted = True
    if interrupted:
        raise KeyboardInterrupt
    if process.returncode > 1:
        raise RuntimeError((said or f"drape sweep has ended with {process.returncode}; its messages are above").strip())
    return read_sweep(out)
