"""What is wrong with an experiment."""

from __future__ import annotations

from dataclasses import dataclass


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

    def __init__(self, faults: list[ConfigFault]):
        self.faults = list(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))
