"""Experiments."""

from __future__ import annotations

import os
from typing import Callable, Optional, Sequence, Union

from . import _core
from .result import Result


class Experiment(_core.ExperimentBase):
    """An experiment: the path of a YAML file, or a dict with the same keys.

    Relative paths in a file start at its folder, those in a dict at the current folder. Raises ConfigError for
    a file that cannot be read.
    """

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
        if isinstance(methods, str):
            methods = [methods]
        if out is not None and not os.fspath(out):
            raise ValueError("out is empty; name a folder, or leave it out for a temporary one")
        record = self._run(
            methods=None if methods is None else list(methods),
            out=out,
            on_iteration=on_iteration,
            on_level=on_level,
            progress=progress,
            report=report,
            overwrite=overwrite,
            allow_memory=allow_memory,
        )
        return Result(record)
