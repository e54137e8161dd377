"""Experiments, and what is wrong with them."""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from dataclasses import dataclass
from typing import Callable, Optional, Sequence, Union

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


class Experiment(_core.ExperimentBase):
    """An experiment: the path of a YAML file, or a dict with the same keys.

    Relative paths in a file start at its folder, those in a dict at the current folder. Raises ConfigError for
    a file that cannot be read.
    """

    __slots__ = ()  # `experiment.levels = 2` is an error: it would change nothing

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
