"""Experiments, and what is wrong with them."""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from dataclasses import dataclass
from typing import Any, Callable, Dict, Optional, Sequence, Union

import numpy

from . import _core
from .result import Result


@dataclass(frozen=True)
class ConfigFault:
    """One fault: a message with a remedy, and where it is; line and column count from 1, 0 is unknown.

    `key` is its path in the experiment, as `Experiment.set` takes it ("obstacles.0.radius"); "" is unknown.
    """

    message: str
    file: str
    line: int
    column: int
    key: str = ""

    def __str__(self) -> str:
        place = [self.file] if self.file else []
        place += [str(n) for n in (self.line, self.column) if n > 0]
        where = ":".join(place) or self.key
        return f"{where}: {self.message}" if where else self.message


class ConfigError(ValueError):
    """Every fault of an experiment, in the order of the file: `error.faults`."""

    def __init__(self, faults: Sequence[ConfigFault]):
        self.faults = list(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


def _write_mesh(path: str, mesh: Sequence[Any], rest: Optional[Any]) -> None:
    """Write a PLY of arrays: (x, triangles), and the flat pieces' corners as texture coordinates."""
    x, triangles = numpy.asarray(mesh[0], float), numpy.asarray(mesh[1])
    if triangles.dtype.kind not in "iu":
        raise TypeError(f"the mesh's triangles must be integers, not {triangles.dtype}")
    if x.ndim != 2 or x.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
        raise ValueError(f"mesh is (n×3 positions, m×3 triangles), not {x.shape} and {triangles.shape}")
    corners = None if rest is None else numpy.asarray(rest, float).reshape(-1, 6)
    if corners is not None and len(corners) != len(triangles):
        raise ValueError(f"rest has corners of {len(corners)} triangles, and the mesh {len(triangles)} triangles")
    with open(path, "w", encoding="ascii") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(x)}\n")
        file.writelines(f"property double {axis}\n" for axis in "xyz")
        file.write(f"element face {len(triangles)}\nproperty list uchar int vertex_indices\n")
        file.write("end_header\n" if corners is None else "property list uchar double texcoord\nend_header\n")
        file.writelines(" ".join(map(repr, row)) + "\n" for row in x.tolist())
        for t, row in enumerate(triangles.tolist()):
            uv = [] if corners is None else [6, *corners[t].tolist()]
            file.write(" ".join(map(repr, [3, *row, *uv])) + "\n")


class Experiment(_core.ExperimentBase):
    """An experiment: the path of a YAML file, or a dict with the same keys.

    mesh: (x, triangles), n×3 positions [m] and m×3 vertex indices, is the cloth in place of `cloth.file`.
    rest: the corners of its triangles in flat pieces, m×6 or m×3×2 [m]; without, the mesh is the rest shape.
    Without a source the mesh has the energies neo_hookean, hinge and gravity, and the method pcs.

    Relative paths in a file start at its folder, those in a dict at the current folder. Raises ConfigError for
    a file that cannot be read.
    """

    __slots__ = ()  # `experiment.levels = 2` is an error: it would change nothing

    def __init__(
        self,
        source: Union[str, os.PathLike, Dict[str, Any], None] = None,
        *,
        mesh: Optional[Sequence[Any]] = None,
        rest: Optional[Any] = None,
    ):
        if source is None:
            if mesh is None:
                raise TypeError("an experiment is the path of a YAML file, a dict, or mesh=(x, triangles)")
            source = {"name": "cloth", "energies": ["neo_hookean", "hinge", "gravity"], "methods": {"pcs": {}}}
        if mesh is None and rest is not None:
            raise TypeError("rest has the corners of a mesh; give mesh=(x, triangles) too")
        super().__init__(source)
        if mesh is None:
            return
        folder = tempfile.mkdtemp(prefix="drape_mesh_")
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        path = os.path.join(folder, "mesh.ply")
        _write_mesh(path, mesh, rest)
        keys = {"shape": "file", "file": path, **({} if rest is None else {"rest": "uv", "uv_unit": "m"})}
        for key, value in keys.items():
            self.set(f"cloth.{key}", value)

    def run(
        self,
        methods: Union[str, Sequence[str], None] = None,
        out: Optional[Union[str, os.PathLike]] = None,
        *,
        on_iteration: Optional[Callable[[_core.Iteration], Optional[str]]] = None,
        on_level: Optional[Callable[[_core.LevelResult], Optional[str]]] = None,
        progress: bool = True,
        report: bool = True,
        overwrite: bool = False,
        allow_memory: bool = False,
    ) -> Result:
        """Run the experiment as `drape run` does, with the same bits.

        methods: their names; None for pcs, or the only one; ["all"] for every one.
        out: results folder; None for a temporary one, without a report, that goes away with the result.
        on_iteration, on_level: called after every Newton iteration and level; returning "stop" ends the run,
            "refine" the level. An exception ends the run and is raised from here.
        progress: whether to show progress on standard error.

        Ctrl-C stops the run and raises KeyboardInterrupt; what is in `out` can be resumed. A failed method is
        a status of the result, except where a prototype in Python raised: that exception is raised at the end.
        Raises ConfigError for a faulty experiment, RuntimeError for an unknown method or a folder that is not
        usable, RunAborted for a run that could not be finished, as on a full disk.
        """
        if out is not None and not os.fspath(out):
            raise ValueError("out is empty; name a folder, or leave it out for a temporary one")
        temporary = tempfile.mkdtemp(prefix="drape_run_") if out is None else None
        folder = os.path.join(temporary or "", "run" if out is None else os.fspath(out))
        try:
            self._run(methods=[methods] if isinstance(methods, str) else list(methods or []), out=folder,
                      on_iteration=on_iteration, on_level=on_level, progress=progress,
                      report=report and not temporary, overwrite=overwrite, allow_memory=allow_memory)
            result = Result(folder)
        except BaseException:
            if temporary:
                shutil.rmtree(temporary, ignore_errors=True)
            raise
        if temporary:
            result._temporary = True
            weakref.finalize(result, shutil.rmtree, temporary, ignore_errors=True)
        return result


def resume(
    folder: Union[str, os.PathLike],
    *,
    on_iteration: Optional[Callable[[_core.Iteration], Optional[str]]] = None,
    on_level: Optional[Callable[[_core.LevelResult], Optional[str]]] = None,
    progress: bool = True,
    report: bool = True,
    allow_memory: bool = False,
) -> Result:
    """Resume an interrupted run in its folder as `drape run --resume` does; a complete one stays as it is.

    The result is that of an uninterrupted run, bit for bit. The arguments are those of `Experiment.run`.
    Prototypes that the run uses must be registered again. Raises RuntimeError for a folder without a run, and
    for a run that cannot be resumed.
    """
    _core._resume(os.fspath(folder), on_iteration, on_level, progress, report, allow_memory)
    return Result(folder)
